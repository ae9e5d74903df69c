// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/palpate/motion_paths.hpp"

namespace palpate::cli {
namespace {

constexpr int kTicks = 2000;

double length(const Quat& q) { return std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z); }

TEST(Motions, Every_tick_has_a_unit_approach_and_a_unit_quaternion) {
  for (const Motion& motion : motions()) {
    for (int i = 0; i < kTicks; ++i) {
      const Waymark w = waymark(motion, double(i) / kTicks, 1);
      ASSERT_NEAR(norm(w.approach), 1, 1e-12) << motion.name << i;
      ASSERT_NEAR(length(w.pose.orientation), 1, 1e-12) << motion.name << i;
    }
  }
}

TEST(Motions, Gaps_run_from_slightly_below_touch_to_the_tolerance) {
  for (const Motion& motion : motions()) {
    double least = 1, most = 0;
    int inside = 0;
    for (int i = 0; i < kTicks; ++i) {
      const double gap = waymark(motion, double(i) / kTicks, 1).gap;
      least = std::min(least, gap);
      most = std::max(most, gap);
      inside += gap > 0 && gap < 1 ? 1 : 0;
    }
    EXPECT_LT(least, -0.05) << motion.name;
    EXPECT_GE(least, -0.11) << motion.name;
    EXPECT_GT(most, 0.9) << motion.name;
    EXPECT_GT(inside, kTicks / 3) << motion.name;
  }
}

TEST(Motions, Steps_are_those_of_a_hand) {
  for (const Motion& motion : motions()) {
    Waymark last = waymark(motion, 0, 1);
    for (int i = 1; i < kTicks; ++i) {
      const Waymark w = waymark(motion, double(i) / kTicks, 1);
      ASSERT_LT(norm(w.pose.position_m - last.pose.position_m), 2e-4) << motion.name << i;
      ASSERT_LT(std::abs(w.gap - last.gap), 0.05) << motion.name << i;
      ASSERT_LT(norm(w.approach - last.approach), 0.05) << motion.name << i;
      const Quat& q = w.pose.orientation;
      const Quat& p = last.pose.orientation;
      ASSERT_GT(std::abs(q.w * p.w + q.x * p.x + q.y * p.y + q.z * p.z), 1 - 1e-4)
          << motion.name << i;
      last = w;
    }
  }
}

TEST(Motions, Seed_changes_the_motion) {
  for (const Motion& motion : motions()) {
    const Waymark a = waymark(motion, 0.3, 1), b = waymark(motion, 0.3, 2),
                  again = waymark(motion, 0.3, 1);
    EXPECT_NE(a.gap, b.gap) << motion.name;
    EXPECT_EQ(a.gap, again.gap) << motion.name;
  }
}

}  // namespace
}  // namespace palpate::cli
