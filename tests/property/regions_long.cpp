// SPDX-License-Identifier: GPL-3.0-or-later
// Three hours of a device's ticks: memory, numbers and the certificate at every one of them.
#include <gtest/gtest.h>

#include "tests/support/baked_scene.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/shapes.hpp"
#include "tools/realtime/thread_counters.hpp"

namespace palpate::test {
namespace {

constexpr double kDelta = 0.05;
constexpr int kOracleEvery = 20000;

/// Slides, parts, jumps, rests, and now and then overlaps.
Pose motion(int i) {
  const double u = 1e-3 * (i % 40000 < 30000 ? i : i - i % 10000);
  const double jump = i % 5000 == 4999 ? 0.3 : 0;
  return {{1.79 + 0.05 * std::sin(0.7 * u), 0.3 * std::sin(0.31 * u) + jump, 0.2 * std::sin(u)},
          turn({0.4 * std::sin(0.5 * u), 0.9 * std::sin(0.11 * u), 0.3 * std::sin(1.3 * u)})};
}

bool finite(double v) { return std::isfinite(v); }

bool is_sound(const TickResult& r) {
  const Vec3d f = r.wrench.force_N;
  const Vec3d t = r.wrench.torque_Nm;
  const Certificate& c = r.certificate;
  return finite(f.x) && finite(f.y) && finite(f.z) && finite(t.x) && finite(t.y) && finite(t.z) &&
         finite(c.error_bound_m) && c.error_bound_m >= 0 && finite(c.force_bound_N) &&
         c.force_bound_N >= 0;
}

void expect_certified(const TickResult& r, double distance) {
  const double bound = r.certificate.error_bound_m;
  if (r.contacts.empty()) {
    EXPECT_GE(distance + bound, 0.9999 * kDelta);
  } else if (distance > 0) {
    EXPECT_LE(std::abs(r.min_distance_m - distance), bound + 2e-6);
  }
}

void run(int ticks) {
  const BakedBody a(bumpy_ball(10, 12, 1), bake::ForEngine::regions);
  const BakedBody b(bumpy_ball(8, 10, 0.8), bake::ForEngine::regions);
  const Settings settings{
      .engine = EngineKind::regions, .delta_m = kDelta, .exact = true, .cluster_radius_m = 0.1};
  BakedScene scene({a.view, b.view}, {{0, 1}}, settings);
  const PlacedTriangles fixed(b.mesh, {});
  realtime::ThreadCounters before = realtime::thread_counters();
  std::uint64_t calls = 0;
  std::uint64_t unsound = 0;
  std::size_t contacts = 0;
  TickResult result;
  for (int i = 0; i < ticks; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const Budget budget = i % 3 == 0 ? Budget{} : Budget{.units = i % 3 == 1 ? 60u : 400u};
    unsound += tick(*scene.engine, poses, budget, result) != Status::ok || !is_sound(result);
    contacts += result.contacts.size();
    if (i % kOracleEvery != 7) continue;
    if (before.allocator_calls) calls += *(realtime::thread_counters() - before).allocator_calls;
    expect_certified(result, distance_of(PlacedTriangles(a.mesh, poses[0]), fixed));
    before = realtime::thread_counters();
  }
  EXPECT_EQ(unsound, 0u);
  EXPECT_EQ(calls, 0u);
  EXPECT_GT(contacts, static_cast<std::size_t>(ticks) / 2);
}

TEST(RegionsLong, ten_million_ticks_are_sound_and_allocate_nothing) { run(10'000'000); }

TEST(RegionsLong, a_million_ticks_are_sound_and_allocate_nothing) { run(1'000'000); }

}  // namespace
}  // namespace palpate::test
