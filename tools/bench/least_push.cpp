// SPDX-License-Identifier: GPL-3.0-or-later
// Time and accuracy of the least push (docs/CONTACT.md) on scenes of two detailed objects.
//
//   bench_least_push [TICKS [SCENE...]]     scenes: jaws, tips, golf, socket, screw, joint
//
// The motions of bench_regions at a contact tolerance of 0.02 radii (gap), and the same pressed by
// 0.9 tolerances more, half of one deep (pressed). A row (CSV) for each question: all contacts, the
// force without a budget, the force within budgets of time (of the thread's processor clock):
// median, 99 % and most of a tick in microseconds, work units and contacts in the mean, ticks that
// are exact, the error of force and torque, root mean square by the largest, and how many ticks a
// start from nothing needs until the force stays within 5 % of the largest.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tools/bench/scenes.hpp"
#include "tools/palpate/clocks.hpp"

namespace palpate::bench {
namespace {

constexpr double kDeltaRel = 0.02;
constexpr double kPressed = 0.9;  // tolerances
constexpr double kBudgets_us[] = {200, 400, 800};
constexpr std::size_t kStarted = 10;

constexpr SceneName kScenes[] = {{"jaws", "jaw_lower", "jaw_upper", true},
                                 {"tips", "jaw_lower", "jaw_lower", false, true},
                                 {"golf", "golf_ball", "golf_ball", false},
                                 {"socket", "golf_ball", "golf_shell", true},
                                 {"screw", "screw", "nut", true},
                                 {"joint", "ball_joint_head", "ball_joint_cup", true}};

Budget within_us(double budget_us) {
  Budget budget;
  if (budget_us > 0) {
    static cli::ProcessorClock clock;
    budget.clock_ns = cli::ProcessorClock::read;
    budget.clock_context = &clock;
    budget.deadline_ns = clock.now_ns() + static_cast<std::uint64_t>(budget_us * 1e3);
  }
  return budget;
}

struct Measured {
  std::vector<double> us, units, contacts;
  std::vector<Vec3d> force_N, torque_Nm;
  int proved = 0;
};

Measured run(Bench& bench, const std::vector<Pose>& poses, double budget_us) {
  Measured out;
  bench.forget();
  for (const Pose& pose : poses) {
    const std::uint64_t start = cli::processor_ns();
    const TickResult r = bench.tick_at(pose, within_us(budget_us));
    out.us.push_back(static_cast<double>(cli::processor_ns() - start) * 1e-3);
    out.units.push_back(static_cast<double>(r.queries));
    out.contacts.push_back(static_cast<double>(r.contacts.size()));
    out.force_N.push_back(r.wrench.force_N);
    out.torque_Nm.push_back(r.wrench.torque_Nm);
    out.proved += r.certificate.truncated() ? 0 : 1;
  }
  return out;
}

double largest(const std::vector<Vec3d>& forces) {
  double most = 0;
  for (const Vec3d& f : forces) most = norm(f) > most ? norm(f) : most;
  return most;
}

/// Ticks at one pose until the force stays within 5 % of the largest.
int settling(Bench& bench, const Pose& pose, double budget_us, Vec3d truth, double peak) {
  constexpr int kMost = 100;
  int settled = 0;
  bench.forget();
  for (int i = 0; i < kMost; ++i) {
    const Vec3d f = bench.tick_at(pose, within_us(budget_us)).wrench.force_N;
    if (norm(f - truth) > 0.05 * peak) settled = i + 1;
  }
  return settled;
}

std::vector<Pose> pressed(const std::vector<Pose>& poses, const std::vector<Vec3d>& forces,
                          double delta) {
  Vec3d out{};
  for (const Vec3d& f : forces) out += f;
  if (!(norm(out) > 0)) return poses;
  std::vector<Pose> deeper = poses;
  for (Pose& pose : deeper) pose.position_m += (-kPressed * delta / norm(out)) * out;
  return deeper;
}

/// @return the exact forces
std::vector<Vec3d> print_rows(const char* scene, const char* motion, Bench& exact, Bench& bench,
                              const std::vector<Pose>& poses) {
  const Measured truth = run(exact, poses, 0);
  const double peak = largest(truth.force_N);
  const auto print = [&](const char* asked, double budget_us, const Measured& m, int ticks) {
    std::printf("%s,%s,%s,%.0f,%.1f,%.1f,%.1f,%.0f,%.1f,%d,%.4f,%.4f,%d,%.3f\n", scene, motion,
                asked, budget_us, percentile(m.us, 0.5), percentile(m.us, 0.99),
                percentile(m.us, 1), mean(m.units), mean(m.contacts), m.proved,
                nrmse(m.force_N, truth.force_N, kStarted),
                nrmse(m.torque_Nm, truth.torque_Nm, kStarted), ticks, peak);
    std::fflush(stdout);
  };
  print("all", 0, truth, 0);
  print("force", 0, run(bench, poses, 0), 0);
  for (const double budget_us : kBudgets_us) {
    const Measured m = run(bench, poses, budget_us);
    print("force", budget_us, m,
          settling(bench, poses.back(), budget_us, truth.force_N.back(), peak));
  }
  return truth.force_N;
}

void measure(const SceneName& scene, int ticks) {
  const Body a(scene.a, kDeltaRel, bake::ForEngine::regions);
  const Body b(scene.b, kDeltaRel, bake::ForEngine::regions);
  const double delta = kDeltaRel * std::min(a.view.header->radius_m, b.view.header->radius_m);
  const std::vector<Pose> poses = motion(scene, a, b, delta, ticks);
  Settings settings{.engine = EngineKind::regions, .delta_m = delta};
  const Limits limits{.nodes = 1, .contacts = 1u << 18, .clusters = 1u << 18};
  Bench bench(a, b, settings, limits);
  settings.exact = true;
  Bench exact(a, b, settings, limits);
  const std::vector<Vec3d> forces = print_rows(scene.name, "gap", exact, bench, poses);
  print_rows(scene.name, "pressed", exact, bench, pressed(poses, forces, delta));
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::atoi(argv[1]) : 100;
  std::printf(
      "scene,motion,asked,budget_us,median_us,p99_us,most_us,units,contacts,proved,force_nrmse,"
      "torque_nrmse,ticks_from_nothing,largest_N\n");
  for (const palpate::bench::SceneName& scene : palpate::bench::kScenes) {
    bool asked = argc < 3;
    for (int i = 2; i < argc; ++i) asked = asked || std::string(argv[i]) == scene.name;
    if (asked) palpate::bench::measure(scene, ticks);
  }
}
