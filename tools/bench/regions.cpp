// SPDX-License-Identifier: GPL-3.0-or-later
// Time and accuracy of the region engine on scenes of two detailed objects.
//
//   bench_regions [TICKS [SCENE...]]     scenes: jaws, golf, socket, screw, joint; default: all
//
// A row (CSV) for each scene, contact tolerance (1, 2, 5 % of the radius) and mode: exact with all
// state kept (warm) or forgotten at each tick (cold), and under budgets of time. Times are of the
// thread's own processor clock, so that a busy machine shows in the caches only. force_nrmse is
// against the exact ticks, of their largest force, over all ticks but the first ten;
// bound_of_force is the median of the certified error over that force; force_step is the largest
// change of force from tick to tick.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "rt_core/palpate_rt.hpp"
#include "tools/bench/scenes.hpp"

namespace palpate {
namespace {

constexpr int kSettled = 10;  // ticks after which a budgeted run counts

std::uint64_t processor_ns(void* = nullptr) {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000 +
         static_cast<std::uint64_t>(t.tv_nsec);
}

using bench::Bench;
using bench::Body;
using bench::mean;
using bench::SceneName;

constexpr SceneName kScenes[] = {{"jaws", "jaw_lower", "jaw_upper", true},
                                 {"golf", "golf_ball", "golf_ball", false},
                                 {"socket", "golf_ball", "golf_shell", true},
                                 {"screw", "screw", "nut", true},
                                 {"joint", "ball_joint_head", "ball_joint_cup", true}};

/// Of all regions: what clusters make of them is the force stage's affair, and neighbours whose
/// nearest point is a common one join a cluster or not by the last bit.
Vec3d summed_force(const Settings& settings, const TickResult& r) {
  Vec3d sum{};
  for (const Contact& c : r.contacts) {
    sum += (settings.stiffness_N_per_m * (settings.delta_m - c.distance_m)) * c.normal;
  }
  return sum;
}

Budget within(double budget_us) {
  Budget budget;
  if (budget_us > 0) {
    budget.clock_ns = processor_ns;
    budget.deadline_ns = processor_ns() + static_cast<std::uint64_t>(budget_us * 1e3);
  }
  return budget;
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

struct Run {
  std::vector<double> us, contacts, near, bound_N;
  std::vector<Vec3d> force_N;
};

Run run(Bench& bench, const std::vector<Pose>& poses, bool cold, double budget_us) {
  Run out;
  bench.forget();
  for (const Pose& pose : poses) {
    if (cold) bench.forget();
    const std::uint64_t start = processor_ns();
    const TickResult r = bench.tick_at(pose, within(budget_us));
    out.us.push_back(static_cast<double>(processor_ns() - start) * 1e-3);
    out.contacts.push_back(static_cast<double>(r.contacts.size()));
    out.near.push_back(static_cast<double>(r.front_nodes));
    out.bound_N.push_back(r.certificate.force_bound_N);
    out.force_N.push_back(summed_force(bench.settings(), r));
  }
  return out;
}

void print_row(const char* scene, double delta_rel, const char* mode, double budget_us,
               const Run& r, const Run& exact) {
  double peak = 0;
  double step = 0;
  for (std::size_t i = 0; i < exact.force_N.size(); ++i) {
    peak = std::max(peak, norm(exact.force_N[i]));
    if (i > 0) step = std::max(step, norm(exact.force_N[i] - exact.force_N[i - 1]));
  }
  std::printf("%s,%g,%s,%g,%.1f,%.1f,%.1f,%.1f,%.1f,%.4f,%.4f,%.4f\n", scene, delta_rel, mode,
              budget_us, mean(r.us), percentile(r.us, 0.5), percentile(r.us, 0.99), mean(r.near),
              mean(r.contacts), bench::nrmse(r.force_N, exact.force_N, kSettled),
              percentile(r.bound_N, 0.5) / peak, step / peak);
  std::fflush(stdout);
}

void measure(const SceneName& scene, double delta_rel, int ticks) {
  const Body a(scene.a, delta_rel, bake::ForEngine::regions);
  const Body b(scene.b, delta_rel, bake::ForEngine::regions);
  const double radius = std::min(a.view.header->radius_m, b.view.header->radius_m);
  const double delta = delta_rel * radius;
  const std::vector<Pose> poses = bench::motion(scene, a, b, delta, ticks);
  Bench bench(a, b, {.engine = EngineKind::regions, .delta_m = delta});
  const Run exact = run(bench, poses, false, 0);
  print_row(scene.name, delta_rel, "warm", 0, exact, exact);
  print_row(scene.name, delta_rel, "cold", 0, run(bench, poses, true, 0), exact);
  for (const double budget_us : {50.0, 100.0, 250.0, 500.0}) {
    print_row(scene.name, delta_rel, "warm", budget_us, run(bench, poses, false, budget_us), exact);
    print_row(scene.name, delta_rel, "cold", budget_us, run(bench, poses, true, budget_us), exact);
  }
}

bool wanted(const SceneName& scene, int argc, char** argv) {
  for (int i = 2; i < argc; ++i) {
    if (std::strcmp(argv[i], scene.name) == 0) return true;
  }
  return argc <= 2;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::max(20, std::atoi(argv[1])) : 300;
  std::printf(
      "scene,delta_rel,mode,budget_us,mean_us,median_us,p99_us,near_regions,contacts,force_nrmse,"
      "bound_of_force,force_step\n");
  for (const palpate::SceneName& scene : palpate::kScenes) {
    if (!palpate::wanted(scene, argc, argv)) continue;
    for (const double delta_rel : {0.01, 0.02, 0.05}) palpate::measure(scene, delta_rel, ticks);
  }
  return 0;
}
