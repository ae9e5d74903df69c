// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/mock/device.hpp"
#include "hal/rotation.hpp"
#include "tests/support/poses.hpp"

namespace palpate::hal::mock {
namespace {

using palpate::test::at_x;

constexpr double kStep_s = 5e-4;
constexpr std::uint64_t kMillisecond = 1'000'000;

TEST(Follower, teleport_becomes_a_motion_within_the_limit_of_speed) {
  Follower follower({.speed_m_per_s = 0.5}, {});
  follower.lead({true, at_x(1.0)});
  double before_m = 0;
  for (int i = 0; i < 6000; ++i) {
    const Target target = follower.advance(at_x(before_m), kStep_s);
    const double now_m = target.pose.position_m.x;
    ASSERT_LE(now_m - before_m, 0.5 * kStep_s * (1 + 1e-9));
    ASSERT_LE(target.twist.linear_m_per_s.x, 0.5 * (1 + 1e-9));
    before_m = now_m;
  }
  EXPECT_NEAR(before_m, 1.0, 1e-6);
}

TEST(Follower, turn_takes_the_short_way_within_its_limit) {
  Follower follower({.turn_rad_per_s = 2.0}, {});
  const Quat to = rotation_from_vector({0, 0, 0.75 * std::numbers::pi});
  follower.lead({true, {{}, {-to.w, -to.x, -to.y, -to.z}}});  // the same rotation
  Target target;
  for (int i = 0; i < 200; ++i) target = follower.advance(target.pose, kStep_s);
  EXPECT_NEAR(vector_from_rotation(target.pose.orientation).z, 0.2, 1e-3);
  for (int i = 0; i < 6000; ++i) target = follower.advance(target.pose, kStep_s);
  EXPECT_NEAR(vector_from_rotation(target.pose.orientation).z, 0.75 * std::numbers::pi, 1e-6);
}

TEST(Follower, waits_where_the_tool_is_held_up) {
  Follower follower({.ahead_m = 0.01, .ahead_rad = 0.1}, {});
  follower.lead({true, {{1, 0, 0}, rotation_from_vector({1, 0, 0})}});
  Target target;
  for (int i = 0; i < 2000; ++i) target = follower.advance({}, kStep_s);
  EXPECT_NEAR(target.pose.position_m.x, 0.01, 1e-9);
  EXPECT_NEAR(vector_from_rotation(target.pose.orientation).x, 0.1, 1e-9);
  EXPECT_EQ(norm(target.twist.linear_m_per_s), 0);
  EXPECT_EQ(norm(target.twist.angular_rad_per_s), 0);
}

TEST(Follower, goes_on_at_a_pace_and_turns_round_at_once_where_it_is_held_up) {
  Follower follower({.speed_m_per_s = 0.5, .ahead_m = 0.01}, {});
  follower.lead({.paced = true, .pace = {{0.2, 0, 0}, {}}});
  double tool_m = 0;
  for (int i = 0; i < 2000; ++i) {
    const Target target = follower.advance(at_x(tool_m), kStep_s);
    ASSERT_NEAR(target.twist.linear_m_per_s.x, 0.2, 1e-12);
    tool_m = target.pose.position_m.x;
  }
  EXPECT_NEAR(tool_m, 0.2, 1e-9);
  for (int i = 0; i < 2000; ++i) {  // held up
    EXPECT_LE(follower.advance(at_x(tool_m), kStep_s).pose.position_m.x, tool_m + 0.01 + 1e-12);
  }
  follower.lead({.paced = true, .pace = {{-0.2, 0, 0}, {}}});
  Target target;
  for (int i = 0; i < 110; ++i) target = follower.advance(at_x(tool_m), kStep_s);
  EXPECT_LT(target.pose.position_m.x, tool_m);
  follower.lead({.paced = true, .pace = {{100, 0, 0}, {}}});
  EXPECT_LE(follower.advance(at_x(tool_m), kStep_s).twist.linear_m_per_s.x, 0.5 * (1 + 1e-9));
}

TEST(Follower, stays_where_a_pace_has_ended) {
  Follower follower({}, {});
  follower.lead({.paced = true, .pace = {{0.2, 0, 0}, {0, 0, 1}}});
  Target target = follower.advance({}, 0.1);
  follower.lead({.paced = true, .pace = {}});
  for (int i = 0; i < 10; ++i) target = follower.advance(target.pose, kStep_s);
  EXPECT_NEAR(target.pose.position_m.x, 0.02, 1e-12);
  EXPECT_NEAR(vector_from_rotation(target.pose.orientation).z, 0.1, 1e-9);
}

TEST(Follower, pulls_nowhere_once_it_has_let_go) {
  Follower follower({}, {});
  follower.lead({true, at_x(1.0)});
  Target target = follower.advance({}, kStep_s);
  EXPECT_GT(target.pose.position_m.x, 0);
  follower.lead({false, {}});
  for (const double x_m : {0.2, -0.3}) {
    target = follower.advance(at_x(x_m), kStep_s);
    EXPECT_EQ(target.pose.position_m.x, x_m);
    EXPECT_EQ(norm(target.twist.linear_m_per_s), 0);
  }
  follower.lead({true, at_x(-0.3)});  // taken up again where it is
  EXPECT_NEAR(follower.advance(at_x(-0.3), kStep_s).pose.position_m.x, -0.3, 1e-12);
}

Options led_in_virtual_time(const FollowLimits& limits) {
  Options options;
  options.time_base = TimeBase::virtual_;
  options.led = limits;
  return options;
}

TEST(MockDevice, led_hand_goes_where_it_is_led_and_no_faster) {
  MockDevice device({}, led_in_virtual_time({.speed_m_per_s = 0.2}));
  ASSERT_FALSE(device.open());
  device.advance_to(kMillisecond);
  device.lead({true, at_x(0.05)});
  double fastest_m_per_s = 0;
  for (std::uint64_t t = 2; t < 1000; ++t) {
    device.advance_to(t * kMillisecond);
    DeviceState state;
    ASSERT_TRUE(device.receive(state));
    fastest_m_per_s = std::max(fastest_m_per_s, norm(state.twist.linear_m_per_s));
  }
  EXPECT_NEAR(device.hand_pose().position_m.x, 0.05, 1e-5);
  // The grip is a spring: it swings a little.
  EXPECT_LT(fastest_m_per_s, 0.2 * 1.5);
}

TEST(MockDevice, led_hand_pulls_no_harder_than_it_may) {
  HandParameters hand;
  const double pull_N = 1.5;
  MockDevice device(hand, led_in_virtual_time({.ahead_m = pull_N / hand.grip_N_per_m}));
  ASSERT_FALSE(device.open());
  device.advance_to(kMillisecond);
  device.lead({true, at_x(10)});
  // A wall at 1 mm, stiff enough to hold that pull within 2 mm.
  for (std::uint64_t t = 2; t < 2000; ++t) {
    DeviceCommand command;
    command.expires_ns = 1'000'000 * kMillisecond;
    command.wrench.force_N.x = -750 * std::max(0.0, device.hand_pose().position_m.x - 0.001);
    device.send(command);
    device.advance_to(t * kMillisecond);
  }
  EXPECT_NEAR(device.hand_pose().position_m.x, 0.003, 1e-4);
}

}  // namespace
}  // namespace palpate::hal::mock
