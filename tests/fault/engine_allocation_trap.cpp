// SPDX-License-Identifier: GPL-3.0-or-later
// The tick never calls the allocator and never touches a page for the first time: counted, not
// assumed.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/allocation_trap.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

// Sliding, parting, overlapping and jumping; exact and cut short; open surfaces too.
TEST(EngineAllocationTrap, ten_thousand_mixed_ticks_call_no_allocator_and_fault_no_page) {
  const BakedBody a(bumpy_ball(14, 20, 1));
  const BakedBody b(bumpy_ball(16, 16, 0.8));
  const BakedBody c(bowl(8, 16, 1.2));
  BakedScene scene({a.view, b.view, c.view}, {{0, 1}, {0, 2}},
                   {.delta_m = 0.05, .exact = true, .cluster_radius_m = 0.1});
  Pose poses[3];
  poses[2] = {{3.2, 0.1, 1}, turn({0, 1, 0})};
  const auto place = [&poses](int i) {
    const double jump = i % 500 == 0 ? 1.5 : 0;
    poses[0] = {{1.75 + 0.1 * std::sin(0.01 * i) + jump, 0.3 * std::sin(0.003 * i),
                 0.2 * std::cos(0.002 * i)},
                turn({0.002 * i, 0.001 * i, 0})};
  };
  expect_no_allocation_and_no_fault(scene, poses, place, 100, 10000);
}

}  // namespace
}  // namespace palpate::test
