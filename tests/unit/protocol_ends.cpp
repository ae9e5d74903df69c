// SPDX-License-Identifier: Apache-2.0
// Both halves of the protocol, talking to each other and to hostile partners.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "../support/packets.hpp"
#include "../support/time.hpp"
#include "hal/protocol/device_end.hpp"
#include "hal/protocol/host_end.hpp"

namespace palpate::hal::protocol {
namespace {

using hal::test::kMs;
using test::some_capabilities;

Command enabled(std::uint32_t sequence, std::uint32_t answers, std::int32_t force_uN = 1'000'000) {
  Command c;
  c.sequence = sequence;
  c.life_us = 5'000;
  c.enable = true;
  c.force_uN = {force_uN, 0, 0};
  c.answers = answers;
  return c;
}

Command disabled(std::uint32_t sequence) {
  Command c;
  c.sequence = sequence;
  c.life_us = 1;
  return c;
}

/// In a session, with one reading sent.
DeviceEnd ready_device() {
  DeviceEnd device(some_capabilities());
  device.begin_session();
  State reading;
  device.stamp(reading);
  return device;
}

bool has_force(DeviceEnd& device, std::uint64_t now_ns) {
  const Command& c = device.output(now_ns);
  return c.force_uN != Command{}.force_uN || c.torque_uNm != Command{}.torque_uNm;
}

State stamped(DeviceEnd& device, std::uint64_t time_ns) {
  State reading;
  reading.device_time_ns = time_ns;
  device.stamp(reading);
  return reading;
}

TEST(DeviceEnd, command_is_rendered_until_its_life_is_over) {
  DeviceEnd device = ready_device();
  ASSERT_TRUE(device.receive(encode(enabled(1, 1)), 10 * kMs));
  EXPECT_EQ(device.output(15 * kMs - 1).force_uN[0], 1'000'000);
  EXPECT_FALSE(has_force(device, 15 * kMs));
  EXPECT_EQ(device.mode(), Mode::expired);
}

TEST(DeviceEnd, late_command_does_not_bring_the_force_back) {
  DeviceEnd device = ready_device();
  ASSERT_TRUE(device.receive(encode(enabled(1, 1)), 0));
  EXPECT_TRUE(device.receive(encode(enabled(2, 1)), 5 * kMs));
  EXPECT_FALSE(has_force(device, 5 * kMs));
  EXPECT_TRUE(device.receive(encode(disabled(3)), 6 * kMs));
  EXPECT_TRUE(device.receive(encode(enabled(4, 1)), 7 * kMs));
  EXPECT_TRUE(has_force(device, 7 * kMs));
}

TEST(DeviceEnd, life_beyond_the_devices_own_is_cut) {
  DeviceEnd device = ready_device();
  Command c = enabled(1, 1);
  c.life_us = kMaxCommandLife_us;
  ASSERT_TRUE(device.receive(encode(c), 0));
  EXPECT_TRUE(has_force(device, 20 * kMs - 1));
  EXPECT_FALSE(has_force(device, 20 * kMs));
}

TEST(DeviceEnd, commands_outside_a_session_are_refused) {
  DeviceEnd device(some_capabilities());
  EXPECT_FALSE(device.receive(encode(disabled(1)), 0));
  device.begin_session();
  EXPECT_TRUE(device.receive(encode(disabled(1)), 0));
  device.end_session();
  EXPECT_FALSE(device.receive(encode(disabled(2)), 0));
}

TEST(DeviceEnd, end_of_the_session_ends_the_force) {
  DeviceEnd device = ready_device();
  ASSERT_TRUE(device.receive(encode(enabled(1, 1)), 0));
  device.end_session();
  EXPECT_FALSE(has_force(device, 1));
}

TEST(DeviceEnd, repeated_and_overtaken_commands_do_not_lengthen_a_life) {
  DeviceEnd device = ready_device();
  ASSERT_TRUE(device.receive(encode(enabled(5, 1)), 0));
  EXPECT_FALSE(device.receive(encode(enabled(5, 1)), 4 * kMs));
  EXPECT_FALSE(device.receive(encode(enabled(4, 1)), 4 * kMs));
  EXPECT_FALSE(has_force(device, 5 * kMs));
  EXPECT_EQ(stamped(device, 0).refused, 2u);
}

TEST(DeviceEnd, sequence_passes_its_wrap) {
  DeviceEnd device = ready_device();
  ASSERT_TRUE(device.receive(encode(enabled(0xffffffffu, 1)), 0));
  EXPECT_FALSE(device.receive(encode(enabled(0, 1)), 1));
  EXPECT_TRUE(device.receive(encode(enabled(1, 1)), 1));
}

TEST(DeviceEnd, commands_of_the_other_kind_are_refused) {
  DeviceEnd device = ready_device();
  EXPECT_FALSE(device.receive(encode(test::some_joint_command()), 0));
}

TEST(DeviceEnd, commands_that_answer_old_readings_or_none_are_refused) {
  DeviceEnd device = ready_device();
  EXPECT_FALSE(device.receive(encode(enabled(1, 0)), 0));
  Command c = enabled(1, 1);
  c.state_age_us = some_capabilities().max_state_age_us + 1;
  EXPECT_FALSE(device.receive(encode(c), 0));
  for (int i = 0; i < 41; ++i) stamped(device, 0);  // 10 ms at 4 kHz, and one
  EXPECT_TRUE(device.receive(encode(enabled(1, 1)), 0));
  stamped(device, 0);
  EXPECT_FALSE(device.receive(encode(enabled(2, 1)), 0));
  EXPECT_FALSE(device.receive(encode(enabled(3, 44)), 0));  // not sent yet
}

TEST(DeviceEnd, force_is_cut_to_its_limit_and_keeps_its_direction) {
  std::mt19937 random(5);
  for (int i = 0; i < 10'000; ++i) {
    DeviceEnd device = ready_device();
    Command c = enabled(1, 1);
    for (auto* v : {&c.force_uN, &c.torque_uNm}) {
      for (auto& component : *v) component = static_cast<std::int32_t>(random());
    }
    if (i == 0) c.force_uN = {INT32_MIN, INT32_MIN, INT32_MIN};
    ASSERT_TRUE(device.receive(encode(c), 0));
    const Command& out = device.output(0);
    const auto length = [](const std::array<std::int32_t, 3>& v) {
      return std::hypot(double(v[0]), double(v[1]), double(v[2]));
    };
    const double most = some_capabilities().max_force_uN;
    ASSERT_LE(length(out.force_uN), most);
    ASSERT_GE(length(out.force_uN), std::min(most, length(c.force_uN)) * (1 - 1e-6));
    ASSERT_LE(length(out.torque_uNm), some_capabilities().max_torque_uNm);
    const double scale = length(out.force_uN) / length(c.force_uN);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NEAR(out.force_uN[k], scale * c.force_uN[k], 1e-6 * most);
    }
  }
}

TEST(DeviceEnd, fault_ends_the_force_until_a_new_session) {
  DeviceEnd device = ready_device();
  ASSERT_TRUE(device.receive(encode(enabled(1, 1)), 0));
  device.set_health(kMotorFailure);
  EXPECT_FALSE(has_force(device, 1));
  EXPECT_EQ(stamped(device, 1).mode, Mode::fault);
  device.set_health(kHealthy);
  EXPECT_FALSE(has_force(device, 2));
  device.begin_session();
  EXPECT_EQ(device.mode(), Mode::idle);
}

TEST(DeviceEnd, overheating_is_a_limit_not_a_fault) {
  DeviceEnd device = ready_device();
  ASSERT_TRUE(device.receive(encode(enabled(1, 1)), 0));
  device.set_health(kOverheated);
  EXPECT_TRUE(has_force(device, 1));
}

TEST(DeviceEnd, homing_takes_the_force_away) {
  DeviceEnd device = ready_device();
  device.set_homing(true);
  ASSERT_TRUE(device.receive(encode(enabled(1, 1)), 0));
  EXPECT_FALSE(has_force(device, 1));
  EXPECT_EQ(stamped(device, 1).mode, Mode::homing);
}

TEST(HostEnd, reading_comes_out_in_si_units) {
  HostEnd host(some_capabilities());
  DeviceState out;
  State s = test::some_state();
  ASSERT_TRUE(host.receive(encode(s), 1000, out));
  EXPECT_EQ(out.sequence, 1u);
  EXPECT_DOUBLE_EQ(out.pose.position_m.x, 0.001);
  EXPECT_DOUBLE_EQ(out.pose.position_m.z, 2.0);
  EXPECT_NEAR(out.pose.orientation.w, 0.8, 1e-9);
  EXPECT_NEAR(out.pose.orientation.y, -0.6, 1e-9);
  EXPECT_EQ(out.faults, kDeviceOverheated);
  EXPECT_EQ(out.buttons, 0x80000001u);
}

TEST(HostEnd, lost_repeated_and_overtaken_readings_are_counted) {
  HostEnd host(some_capabilities());
  DeviceState out;
  State s;
  const auto send = [&](std::uint32_t sequence) {
    s.sequence = sequence;
    s.device_time_ns = sequence * kMs;
    return host.receive(encode(s), 100 * kMs + sequence * kMs, out);
  };
  EXPECT_TRUE(send(7));
  EXPECT_TRUE(send(8));
  EXPECT_FALSE(send(8));
  EXPECT_TRUE(send(12));
  EXPECT_FALSE(send(11));
  EXPECT_EQ(out.sequence, 6u);
  EXPECT_EQ(host.counters().readings, 3u);
  EXPECT_EQ(host.counters().lost, 3u);
  EXPECT_EQ(host.counters().outdated, 2u);
}

TEST(HostEnd, device_time_that_stands_still_is_no_new_reading) {
  HostEnd host(some_capabilities());
  DeviceState out;
  State s = test::some_state();
  ASSERT_TRUE(host.receive(encode(s), 1, out));
  ++s.sequence;
  EXPECT_FALSE(host.receive(encode(s), 2, out));
}

TEST(HostEnd, homing_readings_say_so_and_have_no_pose) {
  HostEnd host(some_capabilities());
  DeviceState out;
  State s = test::some_state();
  s.mode = Mode::homing;
  EXPECT_TRUE(host.receive(encode(s), 1, out));
  EXPECT_TRUE(out.homing);
  DeviceCommand push;
  push.expires_ns = 1'000'000;
  push.wrench.force_N.x = 1;
  Command sent;
  ASSERT_EQ(decode(host.command(push, 1), sent), PacketError::none);
  EXPECT_FALSE(sent.enable);
  EXPECT_EQ(norm(out.pose.position_m), 0.0);
  ++s.sequence;
  ++s.device_time_ns;
  s.mode = Mode::active;
  EXPECT_TRUE(host.receive(encode(s), 2, out));
  EXPECT_FALSE(out.homing);
  EXPECT_GT(norm(out.pose.position_m), 0.0);
}

TEST(HostEnd, silenced_and_failed_device_is_a_fault_of_its_reading) {
  HostEnd host(some_capabilities());
  DeviceState out;
  State s = test::some_state();
  s.health = kHealthy;
  const auto faults = [&](Mode mode, std::uint16_t health) {
    ++s.sequence;
    ++s.device_time_ns;
    s.mode = mode;
    s.health = health;
    EXPECT_TRUE(host.receive(encode(s), s.sequence, out));
    return out.faults;
  };
  EXPECT_EQ(faults(Mode::active, kHealthy), kNoDeviceFault);
  EXPECT_EQ(faults(Mode::expired, kHealthy), kDeviceSilenced);
  EXPECT_EQ(faults(Mode::fault, kMotorFailure), kDeviceFailed);
  EXPECT_EQ(faults(Mode::fault, kBadSensor), kDeviceFailed | kDeviceBadReading);
}

TEST(HostEnd, expired_or_infinite_commands_ask_for_no_force) {
  HostEnd host(some_capabilities());
  DeviceCommand command;
  command.wrench.force_N.x = 2;
  command.expires_ns = 10 * kMs;
  Command out;
  ASSERT_EQ(decode(host.command(command, 4 * kMs), out), PacketError::none);
  EXPECT_TRUE(out.enable);
  EXPECT_EQ(out.life_us, 6000u);
  EXPECT_EQ(out.force_uN[0], 2'000'000);
  ASSERT_EQ(decode(host.command(command, 10 * kMs), out), PacketError::none);
  EXPECT_FALSE(out.enable);
  EXPECT_EQ(out.force_uN[0], 0);
  for (double* component : {&command.wrench.force_N.z, &command.wrench.torque_Nm.y}) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      *component = bad;
      ASSERT_EQ(decode(host.command(command, 4 * kMs), out), PacketError::none);
      EXPECT_FALSE(out.enable);
    }
    *component = 0;
  }
  command.wrench.torque_Nm.y = 1e300;
  ASSERT_EQ(decode(host.command(command, 4 * kMs), out), PacketError::none);
  EXPECT_EQ(out.torque_uNm[1], std::numeric_limits<std::int32_t>::max());
}

TEST(HostEnd, command_names_the_reading_it_answers_and_its_age) {
  HostEnd host(some_capabilities());
  DeviceState first, newest;
  State s;
  s.sequence = 40;
  s.device_time_ns = 1;
  ASSERT_TRUE(host.receive(encode(s), 5 * kMs, first));
  s.sequence = 43;
  s.device_time_ns = 1 + 2 * kMs;
  ASSERT_TRUE(host.receive(encode(s), 7 * kMs, newest));
  DeviceCommand command;
  command.expires_ns = 20 * kMs;
  command.answers = first.sequence;
  command.state_time_ns = first.time_ns;
  Command out;
  ASSERT_EQ(decode(host.command(command, 8 * kMs), out), PacketError::none);
  EXPECT_EQ(out.answers, 40u);
  EXPECT_EQ(out.state_age_us, 3000u);
}

TEST(ClockMap, readings_that_were_held_up_show_their_age) {
  ClockMap map;
  EXPECT_EQ(map.host_time(1000, 500'000), 500'000u);
  for (std::uint64_t i = 1; i < 100; ++i) {
    static_cast<void>(map.host_time(1000 + i * kMs, 500'000 + i * kMs + i % 7 * 1000));
  }
  const std::uint64_t taken = map.host_time(1000 + 100 * kMs, 500'000 + 140 * kMs);
  EXPECT_NEAR(double(taken), 500'000 + 100 * 1e6, 1e5);
}

TEST(ClockMap, slow_and_fast_device_clocks_are_followed) {
  for (const double drift : {-4e-4, -1e-4, 1e-4, 4e-4}) {
    ClockMap map;
    double error = 0;
    for (std::uint64_t i = 0; i < 100'000; ++i) {
      const std::uint64_t host = 1'000'000'000 + i * kMs;
      const auto device = static_cast<std::uint64_t>(double(i * kMs) * (1 + drift));
      const std::uint64_t taken = map.host_time(device, host);
      ASSERT_LE(taken, host);
      error = std::max(error, double(host - taken));
    }
    EXPECT_LE(error, 1000.0) << drift;
  }
}

TEST(ClockMap, clock_that_is_worse_makes_its_readings_old) {
  ClockMap map;
  std::uint64_t age_ns = 0;
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    const std::uint64_t host = i * kMs;
    age_ns = host - map.host_time(i * kMs / 100 * 99, host);
  }
  EXPECT_GT(age_ns, 500 * kMs);
}

// Both ends over a line that loses, repeats and reorders: never a force older than its life.
TEST(BothEnds, force_on_a_bad_line_is_never_older_than_its_life) {
  std::mt19937 random(6);
  DeviceEnd device(some_capabilities());
  HostEnd host(some_capabilities());
  device.begin_session();
  DeviceState reading;
  DeviceCommand command;
  std::vector<Packet> line;
  std::uint64_t sent_ns = 0;
  std::uint64_t rendered = 0;
  for (std::uint64_t now = kMs; now < 20'000 * kMs; now += kMs / 4) {
    if (host.receive(encode(stamped(device, now)), now, reading)) {
      command.answers = reading.sequence;
      command.state_time_ns = reading.time_ns;
    }
    if (now % (7000 * kMs) < 5000 * kMs) {  // else the host is dead
      command.wrench.force_N.x = 1;
      command.expires_ns = now + 5 * kMs;
      const bool silenced = (reading.faults & kDeviceSilenced) != 0;
      line.push_back(silenced ? host.no_force() : host.command(command, now));
      sent_ns = now;
    }
    while (!line.empty() && random() % 4 != 0) {
      const std::size_t which = random() % line.size();
      if (random() % 3 != 0) device.receive(line[which], now);
      if (random() % 3 != 0) line.erase(line.begin() + std::ptrdiff_t(which));
    }
    if (line.size() > 8) line.clear();
    if (!has_force(device, now)) continue;
    ++rendered;
    // At most 8 packets wait; the oldest that can still be accepted was sent 4 ms before.
    ASSERT_LE(now - sent_ns, (5 + 4) * kMs);
  }
  EXPECT_GT(rendered, 10'000u);
}

}  // namespace
}  // namespace palpate::hal::protocol
