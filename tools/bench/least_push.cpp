// SPDX-License-Identifier: GPL-3.0-or-later
// Time and accuracy of the least push on scenes of two detailed objects, beside the penalty.
//
//   bench_least_push [TICKS [SCENE...]]     scenes: jaws, tips, golf, socket, screw, joint
//
// The motions of bench_regions at a contact tolerance of 0.02 radii (gap), and the same pressed by
// 0.9 tolerances more, half of one deep (pressed). A row (CSV) for each: exact ticks with all state
// kept, median, 99 % and most in microseconds of the thread's processor clock, work units in the
// mean, contacts measured; median of the penalty's exact tick; under a budget of time the error of
// the force, root mean square by the largest force, and how many ticks a start from nothing needs
// until the force stays within 5 % of the largest.
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
constexpr double kBudget_us = 400;
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
  std::vector<Vec3d> force_N;
  int untruncated = 0;
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
    out.untruncated += r.certificate.truncated() ? 0 : 1;
  }
  return out;
}

double largest(const std::vector<Vec3d>& forces) {
  double most = 0;
  for (const Vec3d& f : forces) most = norm(f) > most ? norm(f) : most;
  return most;
}

/// Ticks at one pose until the force stays within 5 % of the largest.
int settling(Bench& bench, const Pose& pose, Vec3d truth, double peak) {
  constexpr int kMost = 100;
  int settled = 0;
  bench.forget();
  for (int i = 0; i < kMost; ++i) {
    const Vec3d f = bench.tick_at(pose, within_us(kBudget_us)).wrench.force_N;
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

void print_row(const char* scene, const char* motion, Bench& bench, Bench& penalty,
               const std::vector<Pose>& poses) {
  const Measured exact = run(bench, poses, 0);
  const Measured by_penalty = run(penalty, poses, 0);
  const Measured budgeted = run(bench, poses, kBudget_us);
  const double peak = largest(exact.force_N);
  const int ticks = settling(bench, poses.back(), exact.force_N.back(), peak);
  std::printf("%s,%s,%.1f,%.1f,%.1f,%.0f,%.0f,%.1f,%.4f,%d,%d,%.3f\n", scene, motion,
              percentile(exact.us, 0.5), percentile(exact.us, 0.99), percentile(exact.us, 1),
              mean(exact.units), mean(exact.contacts), percentile(by_penalty.us, 0.5),
              nrmse(budgeted.force_N, exact.force_N, kStarted), budgeted.untruncated, ticks, peak);
  std::fflush(stdout);
}

void measure(const SceneName& scene, int ticks) {
  const Body a(scene.a, kDeltaRel, bake::ForEngine::regions);
  const Body b(scene.b, kDeltaRel, bake::ForEngine::regions);
  const double delta = kDeltaRel * std::min(a.view.header->radius_m, b.view.header->radius_m);
  const std::vector<Pose> poses = motion(scene, a, b, delta, ticks);
  Settings settings{
      .engine = EngineKind::regions, .delta_m = delta, .force_law = ForceLaw::penalty};
  const Limits limits{.nodes = 1, .contacts = 1u << 18, .clusters = 1u << 18};
  Bench penalty(a, b, settings);
  settings.force_law = ForceLaw::least_push;
  Bench bench(a, b, settings, limits);
  print_row(scene.name, "gap", bench, penalty, poses);
  const std::vector<Vec3d> forces = run(bench, poses, 0).force_N;
  print_row(scene.name, "pressed", bench, penalty, pressed(poses, forces, delta));
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::atoi(argv[1]) : 100;
  std::printf(
      "scene,motion,exact_us,exact_us_p99,exact_us_most,units,contacts,penalty_us,"
      "budgeted_nrmse,untruncated,ticks_from_nothing,largest_N\n");
  for (const palpate::bench::SceneName& scene : palpate::bench::kScenes) {
    bool asked = argc < 3;
    for (int i = 2; i < argc; ++i) asked = asked || std::string(argv[i]) == scene.name;
    if (asked) palpate::bench::measure(scene, ticks);
  }
}
