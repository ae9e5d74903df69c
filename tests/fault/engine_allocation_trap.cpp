// SPDX-License-Identifier: GPL-3.0-or-later
// The tick never calls the allocator and never touches a page for the first time: counted, not
// assumed.
#include <gtest/gtest.h>

#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"
#include "tools/realtime/thread_counters.hpp"

namespace palpate::test {
namespace {

// Sliding, parting, overlapping and jumping; exact and cut short; open surfaces too.
TEST(EngineAllocationTrap, ten_thousand_mixed_ticks_call_no_allocator_and_fault_no_page) {
  const BakedBody a(bumpy_ball(14, 20, 1));
  const BakedBody b(bumpy_ball(16, 16, 0.8));
  const BakedBody c(bowl(8, 16, 1.2));
  BakedScene scene({a.view, b.view, c.view}, {{0, 1}, {0, 2}},
                   {.delta_m = 0.05, .exact = true, .cluster_radius_m = 0.1});
  const auto poses_of = [](int i, Pose(&poses)[3]) {
    const double jump = i % 500 == 0 ? 1.5 : 0;
    poses[0] = {{1.75 + 0.1 * std::sin(0.01 * i) + jump, 0.3 * std::sin(0.003 * i),
                 0.2 * std::cos(0.002 * i)},
                turn({0.002 * i, 0.001 * i, 0})};
    poses[2] = {{3.2, 0.1, 1}, turn({0, 1, 0})};
  };
  Pose poses[3];
  TickResult result;
  for (int i = 0; i < 100; ++i) {  // maps code and stack
    poses_of(i, poses);
    ASSERT_EQ(tick(*scene.engine, poses, {}, result), Status::ok);
  }
  const realtime::ThreadCounters before = realtime::thread_counters();
  bool sound = true;
  std::size_t contacts = 0;
  for (int i = 0; i < 10000; ++i) {
    poses_of(i, poses);
    const Budget budget = i % 3 == 0 ? Budget{.units = 50} : Budget{};
    sound &= tick(*scene.engine, poses, budget, result) == Status::ok;
    contacts += result.contacts.size();
  }
  const realtime::ThreadCounters spent = realtime::thread_counters() - before;
  EXPECT_TRUE(sound);
  EXPECT_GT(contacts, 10000u);
  if (!spent.allocator_calls) GTEST_SKIP() << "a sanitizer brings an allocator of its own";
  EXPECT_EQ(*spent.allocator_calls, 0u);
  EXPECT_EQ(spent.minor_faults, 0u);
  EXPECT_EQ(spent.major_faults, 0u);
}

}  // namespace
}  // namespace palpate::test
