// SPDX-License-Identifier: Apache-2.0
// Kinematics of the Novint Falcon: encoder counts to the grip's position, forces to motor values.
//
// Frame: x right, y up, z towards the user, origin where the leg geometry has it, about 0.11 m
// behind the middle of the workspace. Three legs, each an arm of length a turned by its motor
// (theta) and a parallelogram of length b that leads to the grip:
//   (sqrt((u + c - a cos theta)^2 + (w - a sin theta)^2) - (d + e))^2 + (v + f)^2 = b^2
// with (u, v, w) the grip in the leg's own axes. This one equation gives everything here: its root
// in (x, y, z) is forward kinematics, its derivatives are the Jacobian.
//
// Source: Stamper, "A three degree of freedom parallel manipulator with only translational degrees
// of freedom", PhD thesis, University of Maryland, 1997; the lengths are those of the libnifalcon
// project. Departures: its published Jacobian has sin^2(theta2) where sin(theta2) sin(theta3) must
// stand; and forward kinematics starts from one fixed point, so that equal counts give equal
// positions whatever went before.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::hal::falcon {

using JointAngles = std::array<double, 3>;          ///< theta of each arm, rad
using EncoderCounts = std::array<std::int16_t, 3>;  ///< 0 at kZeroAngle_deg
using MotorValues = std::array<std::int16_t, 3>;

/// Count 0 after homing is the arm at this angle.
inline constexpr double kZeroAngle_deg = 35.0;
/// An encoder wheel of 320 slots read in quadrature, on a shaft of 14.25 mm that drives a sector of
/// 110 mm.
inline constexpr double kDegreesPerCount = 14.25 / 110.0 * 360.0 / (4 * 320);
/// What the firmware takes at most, either way.
inline constexpr std::int16_t kMaxMotorValue = 4095;
/// Motor value for a torque of 1 N m about the arm.
inline constexpr double kMotorValuePerNm = 10'000.0;
/// Newton steps of forward kinematics; with them the error is below 1e-10 m anywhere in the
/// workspace.
inline constexpr int kNewtonSteps = 6;

[[nodiscard]] JointAngles angles_of(const EncoderCounts& counts) noexcept;
/// Rounded to the nearest, cut to the range of 16 bits.
[[nodiscard]] EncoderCounts counts_of(const JointAngles& theta_rad) noexcept;

/// Arms' angles for a grip position (m). False, and `out` untouched, where an arm cannot reach.
[[nodiscard]] bool inverse(const Vec3d& position_m, JointAngles& out) noexcept;

/// Grip position (m) for the arms' angles. Always the same work: kNewtonSteps steps. False where
/// they did not arrive: angles that the mechanism cannot take.
[[nodiscard]] bool forward(const JointAngles& theta_rad, Vec3d& out_m) noexcept;

/// d theta / d position, a row an arm (rad/m). False where it has none: a singular pose.
[[nodiscard]] bool jacobian(const Vec3d& position_m, const JointAngles& theta_rad,
                            Mat3d& out) noexcept;

/// Torques about the arms (N m) that give a force at the grip (N): F = J^T tau. False in a singular
/// pose.
[[nodiscard]] bool torques_of(const Vec3d& force_N, const Mat3d& jacobian, Vec3d& out_Nm) noexcept;

/// Motor values for torques. Where one is beyond its limit all are scaled down, so that the force
/// keeps its direction; the sign is the firmware's. Zero where a torque is not finite.
[[nodiscard]] MotorValues motor_values(const Vec3d& torque_Nm) noexcept;

}  // namespace palpate::hal::falcon
