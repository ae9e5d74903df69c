// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/safety.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace palpate::realtime {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A stage with a healthy device and engine, of which a test may spoil one thing.
struct Rig {
  SafetySettings settings = [] {
    SafetySettings s;
    s.arm_ticks = 10;
    s.start_ramp_s = 0.1;
    s.max_force_N = 3;
    s.max_torque_Nm = 0.1;
    return s;
  }();
  SafetyStage stage{settings, kPeriod_s};
  hal::DeviceState reading;
  bool connected = true;
  double age_s = 0;
  std::uint64_t missed = 0;
  Status status = Status::ok;
  Wrench rendered{{0, 0, 2}, {0.05, 0, 0}};
  hal::Twist twist;

  Wrench tick() {
    static_cast<void>(stage.accept(connected ? &reading : nullptr, age_s));
    const Wrench sent = stage.command(status, rendered, twist);
    stage.tick_ended(missed);
    return sent;
  }
  Wrench ticks(int count) {
    Wrench last;
    for (int i = 0; i < count; ++i) last = tick();
    return last;
  }
};

TEST(SafetyStage, without_a_reading_stays_disconnected_at_zero) {
  Rig rig;
  rig.connected = false;
  EXPECT_EQ(norm(rig.ticks(20).force_N), 0.0);
  EXPECT_EQ(rig.stage.state(), LoopState::disconnected);
  EXPECT_TRUE(rig.stage.faults().empty());
}

TEST(SafetyStage, without_a_reading_for_long_is_stale) {
  Rig rig;
  rig.connected = false;
  rig.ticks(1100);
  EXPECT_EQ(rig.stage.state(), LoopState::fault);
  EXPECT_TRUE(rig.stage.faults().has(Fault::stale_state));
}

TEST(SafetyStage, first_reading_arms_and_good_ticks_lead_to_rendering) {
  Rig rig;
  EXPECT_EQ(norm(rig.tick().force_N), 0.0);
  EXPECT_EQ(rig.stage.state(), LoopState::armed);
  EXPECT_EQ(norm(rig.ticks(9).force_N), 0.0);
  EXPECT_EQ(rig.stage.state(), LoopState::armed);
  rig.ticks(5);
  EXPECT_EQ(rig.stage.state(), LoopState::rendering);
}

TEST(SafetyStage, force_ramps_up_evenly_after_rendering_begins) {
  Rig rig;
  double before = 0, steepest = 0;
  for (int i = 0; i < 200; ++i) {
    const double force_N = rig.tick().force_N.z;
    EXPECT_GE(force_N, before);
    steepest = std::max(steepest, force_N - before);
    before = force_N;
  }
  EXPECT_EQ(before, 2.0);
  EXPECT_NEAR(steepest, 2.0 * kPeriod_s / rig.settings.start_ramp_s, 1e-12);
}

TEST(SafetyStage, wrench_never_exceeds_the_limits) {
  Rig rig;
  rig.rendered = {{30, -40, 0}, {0, 0, 5}};
  for (int i = 0; i < 300; ++i) {
    const Wrench sent = rig.tick();
    EXPECT_LE(norm(sent.force_N), 3.0);
    EXPECT_LE(norm(sent.torque_Nm), 0.1);
  }
  const Wrench sent = rig.tick();
  EXPECT_NEAR(sent.force_N.x, 1.8, 1e-12);  // scaled, not clipped: the direction stays
  EXPECT_NEAR(sent.force_N.y, -2.4, 1e-12);
}

/// A rig of other settings that has come to rendering in full.
Rig rendering(void (*change)(SafetySettings&)) {
  Rig rig;
  change(rig.settings);
  rig.stage = SafetyStage(rig.settings, kPeriod_s);
  rig.ticks(300);
  return rig;
}

TEST(SafetyStage, wrench_changes_no_faster_than_the_slew) {
  Rig rig = rendering([](SafetySettings& s) {
    s.max_force_slew_N_per_s = 500;
    s.max_torque_slew_Nm_per_s = 20;
  });
  const Wrench before = rig.tick();
  EXPECT_EQ(before.force_N.z, 2.0);
  rig.rendered = {{0, 0, -2}, {-0.05, 0, 0}};
  Wrench last = before;
  for (int i = 1; i <= 8; ++i) {
    const Wrench sent = rig.tick();
    EXPECT_NEAR(sent.force_N.z, 2 - 0.5 * i, 1e-12);
    EXPECT_LE(norm(sent.torque_Nm - last.torque_Nm), 0.02 + 1e-15);
    last = sent;
  }
  EXPECT_EQ(rig.tick().force_N.z, -2.0);  // there, to the last bit
}

TEST(SafetyStage, slew_turns_a_force_round_within_its_length) {
  Rig rig = rendering([](SafetySettings& s) { s.max_force_slew_N_per_s = 200; });
  for (int i = 0; i < 400; ++i) {
    rig.rendered.force_N = i / 100 % 2 == 0 ? Vec3d{-30, 40, 0} : Vec3d{40, 30, -20};
    EXPECT_LE(norm(rig.tick().force_N), 3.0);
  }
}

TEST(SafetyStage, hand_is_given_no_more_power_than_allowed) {
  Rig rig = rendering([](SafetySettings& s) { s.max_power_W = 1; });
  rig.twist.linear_m_per_s = {0, 0, 4};  // 8 W of 2 N, along the force
  const Wrench given = rig.tick();
  EXPECT_NEAR(given.force_N.z, 0.25, 1e-12);
  EXPECT_NEAR(given.torque_Nm.x, 0.05 / 8, 1e-12);
  rig.twist.angular_rad_per_s = {-140, 0, 0};  // takes back 7 W
  EXPECT_NEAR(rig.tick().force_N.z, 2, 1e-12);
  rig.twist = {{0, 0, -4}, {}};  // against the force the hand spends what it likes
  EXPECT_EQ(rig.tick().force_N.z, 2.0);
}

TEST(SafetyStage, every_doubt_leads_to_its_named_fault_and_to_zero_within_two_ticks) {
  struct Doubt {
    Fault fault;
    std::function<void(Rig&)> raise;
  };
  const Doubt doubts[] = {
      {Fault::stale_state, [](Rig& r) { r.age_s = 0.2; }},
      {Fault::bad_state, [](Rig& r) { r.reading.pose.position_m.y = kNan; }},
      {Fault::bad_state, [](Rig& r) { r.reading.pose.orientation.w = kNan; }},
      {Fault::engine_error, [](Rig& r) { r.status = Status::bad_pose; }},
      {Fault::bad_wrench, [](Rig& r) { r.rendered.force_N.x = kNan; }},
      {Fault::bad_wrench,
       [](Rig& r) { r.rendered.torque_Nm.z = std::numeric_limits<double>::infinity(); }},
      {Fault::device_error, [](Rig& r) { r.reading.faults = hal::kDeviceLost; }},
      {Fault::device_error, [](Rig& r) { r.reading.faults = hal::kDeviceBadCommand; }},
  };
  for (const Doubt& doubt : doubts) {
    SCOPED_TRACE(name(doubt.fault));
    Rig rig;
    ASSERT_EQ(rig.ticks(300).force_N.z, 2.0);
    doubt.raise(rig);
    EXPECT_NEAR(rig.tick().force_N.z, 1.0, 1e-12);
    EXPECT_EQ(rig.tick().force_N.z, 0.0);
    EXPECT_EQ(rig.stage.state(), LoopState::fault);
    EXPECT_TRUE(rig.stage.faults().has(doubt.fault));
    EXPECT_EQ(names(rig.stage.faults()).size(), 1u);
  }
}

TEST(SafetyStage, fault_is_at_zero_with_the_second_command_at_any_rate) {
  for (const double rate_Hz : {500.0, 1000.0, 4000.0, 10000.0}) {
    Rig rig;
    rig.stage = SafetyStage(rig.settings, 1 / rate_Hz);
    ASSERT_EQ(rig.ticks(3000).force_N.z, 2.0);
    rig.age_s = 1;
    EXPECT_NEAR(rig.tick().force_N.z, 1.0, 1e-12) << rate_Hz;
    EXPECT_EQ(rig.tick().force_N.z, 0.0) << rate_Hz;
  }
}

TEST(SafetyStage, doubt_while_armed_is_a_fault_without_any_force) {
  Rig rig;
  rig.ticks(3);
  rig.status = Status::bad_pose;
  EXPECT_EQ(norm(rig.tick().force_N), 0.0);
  EXPECT_EQ(rig.stage.state(), LoopState::fault);
}

TEST(SafetyStage, late_ticks_in_a_row_are_a_fault_and_scattered_ones_are_not) {
  Rig rig;
  for (int i = 0; i < 300; ++i) {
    rig.missed = i % 10 != 0 ? 1 : 0;
    rig.tick();
  }
  EXPECT_TRUE(rig.stage.faults().empty());
  rig.missed = 1;
  rig.ticks(10);
  EXPECT_EQ(rig.stage.state(), LoopState::fault);
  EXPECT_TRUE(rig.stage.faults().has(Fault::missed_deadlines));
  EXPECT_LT(rig.tick().force_N.z, 2.0);
  EXPECT_EQ(rig.tick().force_N.z, 0.0);
}

TEST(SafetyStage, command_held_for_three_periods_is_followed_by_a_third_that_recovers) {
  Rig rig = rendering([](SafetySettings& s) { s.hold_recovery_s = 0.01; });
  rig.missed = 2;
  rig.tick();
  rig.missed = 0;
  EXPECT_NEAR(rig.tick().force_N.z, 2.0 / 3, 1e-12);
  EXPECT_NEAR(rig.tick().force_N.z, 2 * (1.0 / 3 + 0.1), 1e-12);
  EXPECT_EQ(rig.ticks(8).force_N.z, 2.0);
}

TEST(SafetyStage, fault_stays_when_all_is_well_again) {
  Rig rig;
  rig.ticks(300);
  rig.age_s = 1;
  rig.tick();
  rig.age_s = 0;
  EXPECT_EQ(norm(rig.ticks(1000).force_N), 0.0);
  EXPECT_EQ(rig.stage.state(), LoopState::fault);
}

TEST(SafetyStage, further_faults_are_added_to_the_first) {
  Rig rig;
  rig.ticks(300);
  rig.age_s = 1;
  rig.tick();
  rig.reading.pose.position_m.x = kNan;
  rig.tick();
  const auto all = names(rig.stage.faults());
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0], "stale_state");
  EXPECT_EQ(all[1], "bad_state");
}

TEST(SafetyStage, overheated_device_is_no_fault) {
  Rig rig;
  rig.reading.faults = hal::kDeviceOverheated;
  EXPECT_EQ(rig.ticks(300).force_N.z, 2.0);
  EXPECT_TRUE(rig.stage.faults().empty());
}

}  // namespace
}  // namespace palpate::realtime
