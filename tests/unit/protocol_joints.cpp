// SPDX-License-Identifier: Apache-2.0
// Devices with joints: kinematics from descriptors, and both ends of the protocol with them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "../support/packets.hpp"
#include "../support/simulated_rig.hpp"
#include "hal/protocol/device_end.hpp"
#include "hal/protocol/host_end.hpp"
#include "hal/rotation.hpp"

namespace palpate::hal::protocol {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::int32_t kQuarterTurn = 1 << 30;
constexpr std::int32_t kCountsPerTurn = 1 << 20;

Joint joint(double a_m, double d_m, std::int32_t alpha, std::int32_t theta_offset = 0) {
  Joint j;
  j.a_nm = static_cast<std::int32_t>(std::lround(1e9 * a_m));
  j.d_nm = static_cast<std::int32_t>(std::lround(1e9 * d_m));
  j.alpha = alpha;
  j.theta_offset = theta_offset;
  j.counts_per_turn = kCountsPerTurn;
  j.min_counts = -kCountsPerTurn;
  j.max_counts = kCountsPerTurn;
  j.max_torque_uNm = 2'000'000;
  return j;
}

/// Six joints in no special place, one of them counting backwards, one off its zero.
std::vector<Joint> some_arm() {
  std::vector<Joint> arm = {
      joint(0, 0.1, 0),          joint(0.02, 0, kQuarterTurn, kQuarterTurn / 3),
      joint(0.2, 0.01, 0),       joint(0.03, 0.25, -kQuarterTurn),
      joint(0, 0, kQuarterTurn), joint(0.01, 0.06, -kQuarterTurn / 2)};
  arm[2].counts_per_turn = -kCountsPerTurn;
  arm[4].zero_counts = 12345;
  for (std::size_t i = 0; i < arm.size(); ++i) arm[i].index = static_cast<std::uint8_t>(i);
  return arm;
}

JointCounts random_counts(std::mt19937& random) {
  JointCounts counts{};
  for (std::size_t i = 0; i < 6; ++i) {
    counts[i] = static_cast<std::int32_t>(random() % kCountsPerTurn) - kCountsPerTurn / 2;
  }
  return counts;
}

TEST(SerialChain, planar_arm_is_where_school_geometry_has_it) {
  // Two links of 0.3 and 0.2 m: the second's end is the third frame.
  const std::vector<Joint> arm = {joint(0, 0, 0), joint(0.3, 0, 0), joint(0.2, 0, 0)};
  const SerialChain chain(arm);
  for (const double one_rad : {0.0, 0.5, -1.2}) {
    for (const double two_rad : {0.0, 0.7, 2.0}) {
      JointCounts counts{};
      counts[0] = static_cast<std::int32_t>(std::lround(one_rad / (2 * kPi) * kCountsPerTurn));
      counts[1] = static_cast<std::int32_t>(std::lround(two_rad / (2 * kPi) * kCountsPerTurn));
      const Pose pose = chain.pose(counts);
      EXPECT_NEAR(pose.position_m.x, 0.3 * std::cos(one_rad) + 0.2 * std::cos(one_rad + two_rad),
                  1e-5);
      EXPECT_NEAR(pose.position_m.y, 0.3 * std::sin(one_rad) + 0.2 * std::sin(one_rad + two_rad),
                  1e-5);
      EXPECT_NEAR(pose.position_m.z, 0, 1e-12);
      const Vec3d turned = vector_from_rotation(pose.orientation);
      EXPECT_NEAR(turned.z, one_rad + two_rad, 1e-4);
    }
  }
}

TEST(SerialChain, orientation_is_a_unit_quaternion_everywhere) {
  std::mt19937 random(1);
  const SerialChain chain(some_arm());
  for (int i = 0; i < 20'000; ++i) {
    const Quat q = chain.pose(random_counts(random)).orientation;
    ASSERT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12);
  }
}

// The torques are those whose work over a small turn of each joint is the wrench's.
TEST(SerialChain, torques_do_the_work_of_the_wrench) {
  std::mt19937 random(2);
  const SerialChain chain(some_arm());
  const Wrench wrench{{1.5, -2.0, 0.7}, {0.05, 0.02, -0.08}};
  constexpr std::int32_t kStep = 8;
  for (int i = 0; i < 2'000; ++i) {
    const JointCounts counts = random_counts(random);
    const JointTorques torques = chain.torques(counts, wrench);
    for (std::size_t j = 0; j < 6; ++j) {
      JointCounts above = counts, below = counts;
      above[j] += kStep;
      below[j] -= kStep;
      const Pose a = chain.pose(above), b = chain.pose(below);
      const double work = dot(wrench.force_N, a.position_m - b.position_m) +
                          dot(wrench.torque_Nm, rotation_between(b.orientation, a.orientation));
      const double sign = j == 2 ? -1 : 1;
      const double turned = sign * 2 * kStep * 2 * kPi / kCountsPerTurn;
      ASSERT_NEAR(torques[j], work / turned, 1e-7);
    }
  }
}

TEST(SerialChain, torques_beyond_a_joints_limit_are_scaled_down_together) {
  const SerialChain chain(some_arm());
  const Wrench small{{0.1, 0.2, -0.3}, {0.01, 0, 0}};
  const Wrench large{1000.0 * small.force_N, 1000.0 * small.torque_Nm};
  const JointTorques a = chain.torques({}, small), b = chain.torques({}, large);
  double most = 0, ratio = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    most = std::max(most, std::abs(b[i]));
    ratio = std::max(ratio, b[i] / a[i]);
  }
  EXPECT_NEAR(most, 2.0, 1e-12);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(b[i], ratio * a[i], 1e-9);
}

Capabilities joint_capabilities() {
  Capabilities c = test::some_capabilities();
  c.joints = 6;
  c.max_torque_uNm = 2'000'000;
  return c;
}

TEST(JointDevice, reading_and_command_go_through_the_chain) {
  HostEnd host(joint_capabilities(), SerialChain(some_arm()));
  DeviceEnd device(joint_capabilities());
  device.begin_session();
  State s;
  s.is_joint_state = true;
  s.device_time_ns = 1;
  s.joint_counts = {1000, -2000, 3000, -4000, 5000, -6000, 0};
  device.stamp(s);
  DeviceState reading;
  ASSERT_TRUE(host.receive(encode(s), 1000, reading));
  EXPECT_EQ(reading.pose.position_m, SerialChain(some_arm()).pose(s.joint_counts).position_m);
  EXPECT_EQ(reading.faults, kNoDeviceFault);

  DeviceCommand command;
  command.expires_ns = 1'000'000'000;
  command.wrench = {{1, 2, 3}, {}};
  command.answers = reading.sequence;
  command.state_time_ns = reading.time_ns;
  ASSERT_TRUE(device.receive(host.command(command, 2000), 2000));
  const JointTorques torques = SerialChain(some_arm()).torques(s.joint_counts, command.wrench);
  for (std::size_t i = 0; i < kMaxJoints; ++i) {
    EXPECT_NEAR(device.output(2000).joint_torque_uNm[i], 1e6 * torques[i], 0.5);
  }
  ASSERT_TRUE(device.receive(host.no_force(), 3000));
  EXPECT_EQ(device.output(3000).joint_torque_uNm, Command{}.joint_torque_uNm);
}

TEST(JointDevice, count_beyond_a_joints_end_is_a_bad_reading) {
  HostEnd host(joint_capabilities(), SerialChain(some_arm()));
  State s;
  s.is_joint_state = true;
  s.sequence = 1;
  s.device_time_ns = 1;
  s.joint_counts[3] = kCountsPerTurn + 1;
  DeviceState reading;
  ASSERT_TRUE(host.receive(encode(s), 1000, reading));
  EXPECT_EQ(reading.faults, kDeviceBadReading);
}

TEST(JointDevice, poses_of_a_device_with_joints_are_refused) {
  HostEnd host(joint_capabilities(), SerialChain(some_arm()));
  DeviceState reading;
  EXPECT_FALSE(host.receive(encode(test::some_state()), 1000, reading));
  EXPECT_EQ(host.counters().refused, 1u);
}

/// Describes some_arm() and stands still.
class StillArm final : public simulator::OpenDevice {
 public:
  StillArm() : OpenDevice({}) {}
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out) override {
    const auto type = PacketType{static_cast<std::uint8_t>(request.value >> 8)};
    const auto index = static_cast<std::size_t>(request.value & 0xff);
    Packet packet{};
    if (type == PacketType::capabilities) {
      packet = encode(joint_capabilities());
    } else if (type == PacketType::joint && index < some_arm().size()) {
      packet = encode(some_arm()[index == swapped ? 0 : index]);
    } else {
      return {IoStatus::stalled};
    }
    std::copy(packet.begin(), packet.end(), out.begin());
    return {IoStatus::ok, packet.size()};
  }
  std::size_t in(std::span<std::byte> buffer) override {
    if (OpenDevice::in(buffer) == 0) return 0;
    State s;
    s.is_joint_state = true;
    s.sequence = ++sequence_;
    s.device_time_ns = sequence_;
    const Packet packet = encode(s);
    std::copy(packet.begin(), packet.end(), buffer.begin());
    return packet.size();
  }
  std::size_t swapped = kMaxJoints;

 private:
  std::uint32_t sequence_ = 0;
};

TEST(JointDevice, driver_reads_the_joints_and_gives_poses) {
  hal::test::VirtualClock clock;
  StillArm model;
  hal::test::SimulatedRig rig(model, clock, std::make_unique<HostDriver>());
  ASSERT_FALSE(rig.begin());
  ASSERT_TRUE(rig.device->receive(rig.reading));
  EXPECT_EQ(rig.reading.pose.position_m, SerialChain(some_arm()).pose({}).position_m);
}

TEST(JointDevice, driver_notices_a_joint_that_is_not_the_one_asked_for) {
  hal::test::VirtualClock clock;
  StillArm model;
  model.swapped = 3;
  hal::test::SimulatedRig rig(model, clock, std::make_unique<HostDriver>());
  const auto problem = rig.begin();
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->cause, "it describes another joint than it was asked for");
}

}  // namespace
}  // namespace palpate::hal::protocol
