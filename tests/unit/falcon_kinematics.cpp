// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace palpate::hal::falcon {
namespace {

constexpr double kRadPerDegree = 3.14159265358979323846 / 180.0;

/// Positions that the arms reach within the stops.
std::vector<std::pair<Vec3d, JointAngles>> some_poses(std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<std::pair<Vec3d, JointAngles>> poses;
  while (poses.size() < count) {
    const Vec3d p{0.07 * share(random), 0.07 * share(random), 0.125 + 0.065 * share(random)};
    JointAngles theta{};
    if (!inverse(p, theta)) continue;
    bool within = true;
    for (const double t : theta) within &= t > -15 * kRadPerDegree && t < 85 * kRadPerDegree;
    if (within) poses.push_back({p, theta});
  }
  return poses;
}

TEST(FalconKinematics, forward_undoes_inverse_everywhere_in_the_workspace) {
  for (const auto& [p, theta] : some_poses(20'000)) {
    Vec3d back;
    ASSERT_TRUE(forward(theta, back));
    ASSERT_LT(norm(back - p), 1e-9) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(FalconKinematics, published_range_on_the_axis_is_met) {
  JointAngles theta{};
  EXPECT_TRUE(inverse({0, 0, 0.0605}, theta));
  EXPECT_NEAR(theta[0] / kRadPerDegree, -60, 10);
  EXPECT_TRUE(inverse({0, 0, 0.1828}, theta));
  EXPECT_NEAR(theta[0] / kRadPerDegree, 94, 2);
  EXPECT_FALSE(inverse({0, 0, 0.19}, theta));
  EXPECT_NEAR(theta[0], theta[1], 1e-12);
  EXPECT_NEAR(theta[0], theta[2], 1e-12);
}

TEST(FalconKinematics, out_of_reach_is_said) {
  JointAngles theta{};
  EXPECT_FALSE(inverse({0.5, 0, 0.1}, theta));
  EXPECT_FALSE(inverse({0, 0, std::nan("")}, theta));
  Vec3d p{1, 2, 3};
  EXPECT_FALSE(forward({std::nan(""), 0.5, 0.5}, p));
  EXPECT_EQ(p, (Vec3d{1, 2, 3}));
}

// The published Jacobian fails this by a quarter of its entries.
TEST(FalconKinematics, jacobian_agrees_with_central_differences) {
  constexpr double kStep_m = 1e-6;
  for (const auto& [p, theta] : some_poses(2'000)) {
    Mat3d j;
    ASSERT_TRUE(jacobian(p, theta, j));
    const Vec3d rows[] = {j.row0, j.row1, j.row2};
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3d step{axis == 0 ? kStep_m : 0, axis == 1 ? kStep_m : 0, axis == 2 ? kStep_m : 0};
      JointAngles above{}, below{};
      ASSERT_TRUE(inverse(p + step, above));
      ASSERT_TRUE(inverse(p - step, below));
      for (std::size_t i = 0; i < 3; ++i) {
        const double difference = (above[i] - below[i]) / (2 * kStep_m);
        const double entry = axis == 0 ? rows[i].x : axis == 1 ? rows[i].y : rows[i].z;
        ASSERT_NEAR(entry, difference, 1e-5 * std::max(1.0, std::abs(entry)));
      }
    }
  }
}

// The thesis' closed form, with the corrected last column.
TEST(FalconKinematics, jacobian_agrees_with_the_closed_form) {
  constexpr double kA = 0.06, kB = 0.1025, kC = 0.01443, kF = -0.025, kR = 0.04, kS = -0.02309;
  const double stands_deg[] = {105, -15, -135};
  for (const auto& [p, theta] : some_poses(2'000)) {
    Mat3d j;
    ASSERT_TRUE(jacobian(p, theta, j));
    const Vec3d rows[] = {j.row0, j.row1, j.row2};
    for (std::size_t i = 0; i < 3; ++i) {
      const double c = std::cos(stands_deg[i] * kRadPerDegree);
      const double s = std::sin(stands_deg[i] * kRadPerDegree);
      const double u = p.x * c + p.y * s - kR, v = -p.x * s + p.y * c - kS;
      const double t1 = theta[i], t3 = std::acos((v + kF) / kB);
      const double t2 = std::atan2(p.z - kA * std::sin(t1), u + kC - kA * std::cos(t1));
      const double delta = -kA * std::sin(t3) * std::sin(t1 - t2);
      ASSERT_NEAR(rows[i].x, (c * std::cos(t2) * std::sin(t3) - s * std::cos(t3)) / delta, 1e-6);
      ASSERT_NEAR(rows[i].y, (s * std::cos(t2) * std::sin(t3) + c * std::cos(t3)) / delta, 1e-6);
      ASSERT_NEAR(rows[i].z, std::sin(t2) * std::sin(t3) / delta, 1e-6);
    }
  }
}

TEST(FalconKinematics, torques_do_the_work_of_the_force) {
  const Vec3d force{1.5, -2, 0.7};
  for (const auto& [p, theta] : some_poses(1'000)) {
    Mat3d j;
    Vec3d torque;
    ASSERT_TRUE(jacobian(p, theta, j));
    ASSERT_TRUE(torques_of(force, j, torque));
    for (const Vec3d& move : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
      ASSERT_NEAR(dot(torque, j * move), dot(force, move), 1e-9);
    }
  }
}

TEST(FalconKinematics, singular_jacobian_is_said) {
  Vec3d torque{1, 1, 1};
  EXPECT_FALSE(torques_of({1, 0, 0}, {{1, 0, 0}, {1, 0, 0}, {0, 0, 1}}, torque));
  EXPECT_EQ(torque, (Vec3d{1, 1, 1}));
}

TEST(FalconKinematics, counts_and_angles_are_one_another) {
  for (int c = -3000; c <= 3000; c += 7) {
    const auto count = static_cast<std::int16_t>(c);
    const EncoderCounts counts{count, 0, static_cast<std::int16_t>(-count)};
    EXPECT_EQ(counts_of(angles_of(counts)), counts);
  }
  EXPECT_NEAR(angles_of({1, 0, 0})[0] / kRadPerDegree - 35.0, 0.036435, 1e-6);
}

TEST(FalconKinematics, every_count_gives_a_finite_pose_or_none) {
  for (int c = -32768; c < 32768; c += 37) {
    const auto count = static_cast<std::int16_t>(c);
    Vec3d p{};
    if (!forward(angles_of({count, 0, 100}), p)) continue;
    EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  }
}

TEST(FalconMotors, values_are_scaled_down_together) {
  EXPECT_EQ(motor_values({0.1, -0.2, 0.3}), (MotorValues{-1000, 2000, -3000}));
  EXPECT_EQ(motor_values({1.0, -0.5, 0}), (MotorValues{-4095, 2048, 0}));
  EXPECT_EQ(motor_values({1e300, 0, 0}), (MotorValues{-4095, 0, 0}));
  EXPECT_EQ(motor_values({}), MotorValues{});
}

TEST(FalconMotors, what_is_not_finite_is_no_force) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(motor_values({std::nan(""), 0, 0}), MotorValues{});
  EXPECT_EQ(motor_values({0, kInfinity, 0}), MotorValues{});
}

}  // namespace
}  // namespace palpate::hal::falcon
