// SPDX-License-Identifier: GPL-3.0-or-later
// What levels of detail and budgets do to the force from tick to tick (docs/STABILITY.md).
//
//   bench_steadiness [TICKS [N]]    default: 640 ticks of 1 ms
//
// With N, `regions` alone on jaws ground, under N budgets from 200 to 2,600 units.
//
// A row (CSV) for each motion, speed, setting and budget: the largest change of force between two
// ticks over that of the same engine's exact query on the same motion, of the engine as it is and
// steadied as `palpate run` does; how many ticks change it by more than four fifths of the exact
// query's largest change; and the error of the force against the exact one (NRMSE of the peak).
// Virtual time and work units: the same figures on every machine.
//
// Motions: `ground`, jaws of 6000 triangles ground on each other; `rolled`, an ellipsoid that rolls
// over a golf ball of 20,000 triangles, 0.4 delta above it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "tools/bench/bench_query.hpp"
#include "tools/realtime/steady_query.hpp"

namespace palpate::bench {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr std::size_t kStart = 50;  // ticks that follow the start and are not compared
constexpr std::uint64_t kUnlimited = Budget{}.units;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr realtime::SteadyRates kNotSteadied{kInfinity, kInfinity};

struct Setting {
  const char* name;
  Settings settings;
  std::vector<std::uint64_t> budgets;
};

/// A unit of the one engine is a convex query, of the other a box against sixteen.
const std::vector<std::uint64_t> kOfLevels = {kUnlimited, 200, 60};
const std::vector<std::uint64_t> kOfRegions = {2500, 1000, 500, 200};

const std::vector<Setting> kSettings = {{"s0 = 0.005", {.s0 = 0.005}, kOfLevels},
                                        {"s0 = 0.015", {.s0 = 0.015}, kOfLevels},
                                        {"s0 = 0.05", {.s0 = 0.05}, kOfLevels},
                                        {"kappa = 0.1", {.s0 = 1e3, .kappa = 0.1}, kOfLevels},
                                        {"regions", {.engine = EngineKind::regions}, kOfRegions}};

struct Scene {
  const char* name;
  const Body& a;
  const Body& b;
  double delta_m;
};

std::vector<Vec3d> forces(const Scene& scene, const std::vector<Pose>& poses, Settings settings,
                          std::uint64_t units, const realtime::SteadyRates& rates) {
  settings.delta_m = scene.delta_m;
  Bench bench(scene.a, scene.b, settings);
  BenchQuery contacts(bench);
  realtime::SteadyQuery query(contacts, rates, settings.stiffness_N_per_m, kPeriod_s);
  std::vector<Vec3d> out;
  for (const Pose& pose : poses) {
    TickResult r;
    if (query.tick(pose, {.units = units}, r) != Status::ok) std::abort();
    out.push_back(r.wrench.force_N);
  }
  return out;
}

std::vector<double> steps(const std::vector<Vec3d>& forces) {
  std::vector<double> out;
  for (std::size_t i = kStart; i < forces.size(); ++i) {
    out.push_back(norm(forces[i] - forces[i - 1]));
  }
  return out;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

void print_column(const std::vector<Vec3d>& found, const std::vector<Vec3d>& exact) {
  const std::vector<double> of_found = steps(found);
  const double of_exact_N = largest(steps(exact));
  const auto large = std::count_if(of_found.begin(), of_found.end(),
                                   [&](double step_N) { return step_N > 0.8 * of_exact_N; });
  std::printf(",%.2f,%d,%.3f", largest(of_found) / of_exact_N, static_cast<int>(large),
              nrmse(found, exact, kStart));
}

std::vector<std::uint64_t> budgets_of_regions(int count) {
  constexpr int kLeast = 200;
  constexpr int kMost = 2600;
  std::vector<std::uint64_t> out;
  for (int i = 0; i < count; ++i) {
    out.push_back(static_cast<std::uint64_t>(kLeast + i * (kMost - kLeast) / (count - 1)));
  }
  return out;
}

void measure(const Scene& scene, double speed_m_per_s, const std::vector<Pose>& poses,
             const std::vector<Setting>& chosen) {
  for (const Setting& setting : chosen) {
    const std::vector<Vec3d> exact = forces(
        scene, poses, {.engine = setting.settings.engine, .exact = true}, kUnlimited, kNotSteadied);
    for (const std::uint64_t units : setting.budgets) {
      const std::string budget = units == kUnlimited ? "none" : std::to_string(units);
      std::printf("%s,%g,\"%s\",%s,%.4f", scene.name, speed_m_per_s, setting.name, budget.c_str(),
                  largest(steps(exact)));
      const Settings& settings = setting.settings;
      print_column(forces(scene, poses, settings, units, kNotSteadied), exact);
      print_column(forces(scene, poses, settings, units, {}), exact);
      std::printf("\n");
      std::fflush(stdout);
    }
  }
}

/// The bite opens and closes by 0.2 mm.
Pose ground(double speed_m_per_s, int tick) {
  const double phase = speed_m_per_s * tick;  // a radian a millimetre, a millisecond a tick
  const double half_turn = 0.005 * std::sin(0.5 * phase);
  const double w = 1 / std::sqrt(1 + half_turn * half_turn);
  return {{0.001 * std::sin(phase), 0.0005 * (1 - std::cos(phase)),
           -0.00015 + 0.0002 * (1 - std::cos(0.3 * phase))},
          {w, 0, 0, w * half_turn}};
}

void measure_ground(int ticks, const std::vector<Setting>& settings) {
  constexpr double kDelta_m = 0.0005;
  const Body upper("jaw_upper", 0.02, bake::ForEngine::both, 6000);
  const Body lower("jaw_lower", 0.02, bake::ForEngine::both, 6000);
  for (const double speed : {0.1, 0.3}) {
    std::vector<Pose> poses;
    for (int i = 0; i < ticks; ++i) poses.push_back(ground(speed, i));
    measure({"ground", upper, lower, kDelta_m}, speed, poses, settings);
  }
}

void measure_rolled(int ticks) {
  constexpr double kDeltaRel = 0.02;
  constexpr SceneName kScene{"rolled", "ellipsoid", "golf_ball", false};
  constexpr int kFaster = 3;  // every third pose of a way at 0.1 m/s
  const Body a(kScene.a, kDeltaRel, bake::ForEngine::both, 2000);
  const Body b(kScene.b, kDeltaRel, bake::ForEngine::both, 20'000);
  const double delta_m = kDeltaRel * a.view.header->radius_m;
  const std::vector<Pose> slow = motion(kScene, a, b, delta_m, kFaster * ticks);
  std::vector<Pose> fast;
  for (std::size_t i = 0; i < slow.size(); i += kFaster) fast.push_back(slow[i]);
  measure({"rolled", a, b, delta_m}, 0.1, {slow.begin(), slow.begin() + ticks}, kSettings);
  measure({"rolled", a, b, delta_m}, 0.3, fast, kSettings);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::max(100, std::atoi(argv[1])) : 640;
  std::printf("motion,speed_m_per_s,setting,units,exact_step_N");
  for (const char* column : {"engine", "steadied"}) {
    std::printf(",%s_step,%s_large,%s_nrmse", column, column, column);
  }
  std::printf("\n");
  if (argc > 2) {
    const std::vector<std::uint64_t> budgets =
        palpate::bench::budgets_of_regions(std::max(2, std::atoi(argv[2])));
    const palpate::Settings regions{.engine = palpate::EngineKind::regions};
    palpate::bench::measure_ground(ticks, {{"regions", regions, budgets}});
    return 0;
  }
  palpate::bench::measure_ground(ticks, palpate::bench::kSettings);
  palpate::bench::measure_rolled(ticks);
  return 0;
}
