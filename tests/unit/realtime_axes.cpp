// SPDX-License-Identifier: GPL-3.0-or-later
// Devices with fewer axes than six: what they are asked for, and what the hand feels.
#include "tools/realtime/device_axes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/virtual_loop.hpp"

namespace palpate::realtime {
namespace {

using test::VirtualLoop;

constexpr double kFloor_N_per_m = 600;

/// A bar along x, felt at both ends by the half-space z < 0: a force and a torque that depend on
/// how the bar is turned.
Wrench bar_on_wall(const Pose& tool) {
  Wrench w;
  for (const double x_m : {-0.02, 0.03}) {
    const Vec3d arm_m = rotation(tool.orientation) * Vec3d{x_m, 0, 0};
    const double depth_m = -(tool.position_m + arm_m).z;
    if (depth_m <= 0) continue;
    const Vec3d force_N{0, 0, 0.5 * kFloor_N_per_m * depth_m};
    w.force_N += force_N;
    w.torque_Nm += cross(arm_m, force_N);
  }
  return w;
}

Status answer(const Pose& tool, const Budget& /*budget*/, TickResult& out) {
  out = {};
  out.wrench = bar_on_wall(tool);
  return Status::ok;
}

Quat about_y(double angle_rad) {
  return {std::cos(0.5 * angle_rad), 0, std::sin(0.5 * angle_rad), 0};
}

/// Presses 5 mm into the wall, turned by then.
hal::mock::HandParameters pressing_hand(const Quat& turned) {
  hal::mock::HandParameters hand;
  hand.script = {
      {0, {{0, 0, 0.03}, {}}}, {0.5, {{0, 0, -0.005}, turned}}, {1000, {{0, 0, -0.005}, turned}}};
  return hand;
}

struct Axes {
  std::uint8_t sensed = 3, rendered = 3;
};

/// What a device is asked for in 2 s at 1 kHz.
struct Felt {
  std::vector<TraceRecord> records;
  LoopReport report;
  Quat hand;  ///< orientation in the end, sensed or not
};

Felt feel(const hal::mock::HandParameters& hand, Axes axes, const Quat& fixed) {
  hal::mock::Options options = VirtualLoop::virtual_time(2000);
  options.sensed_dof = axes.sensed;
  options.rendered_dof = axes.rendered;
  LoopSettings settings;
  settings.periods = 2000;
  settings.passivity_control = true;
  fit_to(hal::mock::MockDevice(hand, options).capabilities(), fixed, settings);
  VirtualLoop rig(hand, settings, answer, 1u << 14, options);
  const LoopReport report = rig.run();
  return {rig.records(), report, rig.device.hand_pose().orientation};
}

Pose pose_of(const TraceRecord& r) {
  return {{r.position_m[0], r.position_m[1], r.position_m[2]},
          {r.orientation[0], r.orientation[1], r.orientation[2], r.orientation[3]}};
}

/// What was sent, from the end of the ramp on, is the force of a device of six axes at that pose;
/// no torque.
void expect_the_force_of_six_axes(const Felt& felt) {
  ASSERT_EQ(felt.records.size(), 2000u);
  double torque_Nm = 0;
  for (const TraceRecord& r : felt.records) {
    const Wrench whole = bar_on_wall(pose_of(r));
    torque_Nm = std::max(torque_Nm, norm(whole.torque_Nm));
    for (const float t_Nm : r.sent_torque_Nm) ASSERT_EQ(t_Nm, 0.0F);
    if (r.tick < 400) continue;
    ASSERT_NEAR(static_cast<double>(r.sent_force_N[2]), whole.force_N.z, 1e-6);
  }
  EXPECT_GT(torque_Nm, 0.01);  // there was some to be left out
  EXPECT_EQ(felt.report.state, LoopState::rendering);
  EXPECT_EQ(felt.report.torque_Nm_max, 0.0);
  EXPECT_GE(felt.report.energy_J_min, -1e-9);
}

TEST(ThreeAxes, fixed_orientation_is_the_scenes_and_the_force_that_of_six_axes) {
  const Quat fixed = about_y(0.2);
  const Felt felt = feel(pressing_hand(about_y(-0.5)), {3, 3}, fixed);
  expect_the_force_of_six_axes(felt);
  for (const TraceRecord& r : felt.records) ASSERT_EQ(pose_of(r).orientation.y, fixed.y);
  // At rest where grip and wall balance, as the bar lies.
  const TraceRecord& last = felt.records.back();
  const Wrench wall = bar_on_wall(pose_of(last));
  EXPECT_NEAR(300 * (-0.005 - last.position_m[2]) + wall.force_N.z, 0, 1e-4);
}

TEST(ThreeAxes, sensed_orientation_is_followed_and_the_force_that_of_six_axes) {
  const Quat turned = about_y(0.3);
  const Felt felt = feel(pressing_hand(turned), {6, 3}, about_y(0.2));
  expect_the_force_of_six_axes(felt);
  EXPECT_NEAR(felt.records.back().orientation[2], turned.y, 1e-6);
}

TEST(ThreeAxes, hand_turns_as_if_there_were_no_contact) {
  const Quat turned = about_y(0.3);
  const Felt felt = feel(pressing_hand(turned), {6, 3}, {});
  hal::mock::HandParameters away = pressing_hand(turned);
  for (hal::mock::Waypoint& w : away.script) w.pose.position_m.z += 1;
  const Felt free = feel(away, {6, 3}, {});
  EXPECT_EQ(felt.hand.y, free.hand.y);
  // A device of six axes feels it.
  EXPECT_GT(std::abs(feel(pressing_hand(turned), {6, 6}, {}).hand.y - free.hand.y), 1e-3);
}

TEST(ThreeAxes, torque_that_is_not_rendered_takes_nothing_from_the_force) {
  LoopSettings settings;
  settings.safety.max_torque_Nm = 1;
  hal::Capabilities device;
  device.max_force_N = 8;
  device.max_torque_Nm = 0.5;  // says so, and yet has no motors for it
  device.rendered_dof = 3;
  fit_to(device, {}, settings);
  EXPECT_EQ(settings.safety.max_torque_Nm, 0.0);
  // Power: only what the force gives counts.
  settings.safety.max_power_W = 1;
  settings.safety.arm_ticks = 1;
  settings.safety.start_ramp_s = 0;
  SafetyStage stage(settings.safety, 1e-3);
  const hal::Twist spin{{}, {0, 0, 1000}};
  hal::DeviceState reading;
  Wrench sent;
  for (int i = 0; i < 10; ++i) {
    static_cast<void>(stage.accept(&reading, 0));
    sent = stage.command(Status::ok, {{0, 0, 2}, {0, 0, 0.4}}, spin);
    stage.tick_ended(0);
  }
  EXPECT_EQ(sent.force_N.z, 2.0);
  EXPECT_EQ(norm(sent.torque_Nm), 0.0);
  // Passivity: what is owed is taken back by the force alone.
  PassivityController control(settings.passivity_limits);
  control.observe({{0, 0, 1}, {}}, {0, 0, 1e-3}, {0, 0, 1}, 1e-3);  // 1 mJ given out at 1 m/s
  const Wrench damped = control.control({}, 1e-3);
  EXPECT_NEAR(damped.force_N.z, -1.0, 1e-9);  // 1 mJ a period of 1 ms at 1 m/s
  EXPECT_EQ(norm(damped.torque_Nm), 0.0);
}

}  // namespace
}  // namespace palpate::realtime
