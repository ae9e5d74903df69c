// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/device.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

namespace palpate::hal::mock {
namespace {

constexpr std::uint64_t kMs = 1'000'000;

Options in_virtual_time() {
  Options options;
  options.time_base = TimeBase::virtual_;
  return options;
}

DeviceCommand push(double force_N, std::uint64_t expires_ns) {
  DeviceCommand command;
  command.sequence = 1;
  command.expires_ns = expires_ns;
  command.wrench.force_N.x = force_N;
  return command;
}

DeviceState newest(Device& device) {
  DeviceState state;
  EXPECT_TRUE(device.receive(state));
  return state;
}

TEST(MockDevice, first_reading_comes_with_the_start_of_time) {
  MockDevice device({}, in_virtual_time());
  ASSERT_FALSE(device.open());
  ASSERT_FALSE(device.start());
  DeviceState state;
  EXPECT_FALSE(device.receive(state));
  device.advance_to(5 * kMs);
  ASSERT_TRUE(device.receive(state));
  EXPECT_EQ(state.sequence, 1u);
  EXPECT_EQ(state.time_ns, 5 * kMs);
}

TEST(MockDevice, readings_are_counted_and_timed_at_its_rate) {
  MockDevice device({}, in_virtual_time());
  ASSERT_FALSE(device.open());
  device.advance_to(kMs);
  device.advance_to(11 * kMs);
  const DeviceState state = newest(device);
  EXPECT_EQ(state.sequence, 21u);  // 10 ms at 2 kHz after the first
  EXPECT_EQ(state.time_ns, 11 * kMs);
}

TEST(MockDevice, command_pushes_the_hand_until_it_expires) {
  MockDevice device({}, in_virtual_time());
  ASSERT_FALSE(device.open());
  device.advance_to(kMs);
  device.send(push(1.5, 1000 * kMs));
  device.advance_to(999 * kMs);
  EXPECT_NEAR(newest(device).pose.position_m.x, 1.5 / HandParameters{}.grip_N_per_m, 1e-5);
  device.advance_to(2500 * kMs);
  EXPECT_NEAR(newest(device).pose.position_m.x, 0, 1e-5);
}

TEST(MockDevice, expired_command_moves_nothing) {
  MockDevice device({}, in_virtual_time());
  ASSERT_FALSE(device.open());
  device.advance_to(10 * kMs);
  device.send(push(5, 10 * kMs));
  device.advance_to(100 * kMs);
  EXPECT_EQ(newest(device).pose.position_m.x, 0.0);
}

TEST(MockDevice, command_beyond_its_limits_is_shortened) {
  Options options = in_virtual_time();
  options.max_force_N = 3;
  MockDevice device({}, options);
  ASSERT_FALSE(device.open());
  device.advance_to(kMs);
  device.send(push(1000, 10'000 * kMs));
  device.advance_to(5000 * kMs);
  EXPECT_NEAR(newest(device).pose.position_m.x, 3 / HandParameters{}.grip_N_per_m, 1e-9);
}

TEST(MockDevice, command_that_is_not_a_number_is_not_rendered_and_reported) {
  MockDevice device({}, in_virtual_time());
  ASSERT_FALSE(device.open());
  device.advance_to(kMs);
  device.send(push(std::numeric_limits<double>::quiet_NaN(), 1000 * kMs));
  device.advance_to(20 * kMs);
  const DeviceState state = newest(device);
  EXPECT_EQ(state.pose.position_m.x, 0.0);
  EXPECT_EQ(state.faults, kDeviceBadCommand);
  EXPECT_EQ(device.faults(), kDeviceBadCommand);
}

TEST(MockDevice, impossible_hand_is_refused_at_open) {
  HandParameters hand;
  hand.mass_kg = -1;
  MockDevice device(hand, in_virtual_time());
  const auto problem = device.open();
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "open");
  EXPECT_TRUE(device.start());
}

TEST(MockDevice, in_virtual_time_is_deterministic_whatever_the_strides) {
  HandParameters hand;
  Pose away;
  away.position_m = {0.1, 0.02, -0.03};
  away.orientation = {0.8, 0.6, 0, 0};
  hand.script = {{0, {}}, {0.3, away}, {0.5, {}}};
  MockDevice fine(hand, in_virtual_time()), coarse(hand, in_virtual_time());
  ASSERT_FALSE(fine.open());
  ASSERT_FALSE(coarse.open());
  for (std::uint64_t t = 1; t <= 1001; ++t) fine.advance_to(t * kMs);
  coarse.advance_to(kMs);
  coarse.advance_to(1001 * kMs);
  const DeviceState a = newest(fine), b = newest(coarse);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.pose.position_m, b.pose.position_m);
  EXPECT_EQ(a.pose.orientation.w, b.pose.orientation.w);
  EXPECT_EQ(a.twist.linear_m_per_s, b.twist.linear_m_per_s);
}

TEST(MockDevice, in_real_time_keeps_reading_until_stopped) {
  MockDevice device({}, {});
  ASSERT_FALSE(device.open());
  ASSERT_FALSE(device.start());
  DeviceState state;
  while (state.sequence < 50) {
    static_cast<void>(device.receive(state));
    device.send(push(1, std::numeric_limits<std::uint64_t>::max()));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  device.stop();
  device.stop();
  static_cast<void>(device.receive(state));
  EXPECT_GT(state.pose.position_m.x, 0);
  EXPECT_FALSE(device.receive(state));
}

}  // namespace
}  // namespace palpate::hal::mock
