// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::hal::falcon {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadPerDegree = kPi / 180.0;

// Lengths in metres, with the letters of the thesis.
constexpr double kA = 0.060;             // arm
constexpr double kB = 0.1025;            // parallelogram
constexpr double kC = 0.01443;           // grip's joint to its middle
constexpr double kDPlusE = 2 * 0.01125;  // ends of the parallelogram
constexpr double kF = -0.025;            // sideways offset of the parallelogram
constexpr double kR = 0.0400;            // motor's axis to the middle
constexpr double kS = -0.02309;          // motor's axis sideways

/// Within the workspace; 400,000 poses of arms between -15 and 90 degrees were all reached from
/// here to 5e-11 m.
constexpr Vec3d kStart_m{0, 0, 0.11};
/// Farther from a solution than rounding leads.
constexpr double kArrived_m2 = 1e-9;

struct Leg {
  double cosine, sine;  ///< of the angle about z at which it stands
};

// At 105, -15 and -135 degrees.
constexpr std::array<Leg, 3> kLegs{Leg{-0.25881904510252076, 0.96592582628906829},
                                   Leg{0.96592582628906829, -0.25881904510252076},
                                   Leg{-0.70710678118654752, -0.70710678118654752}};

struct LegPoint {
  double u, v, w;
};

LegPoint in_leg(const Vec3d& p, const Leg& leg) noexcept {
  return {p.x * leg.cosine + p.y * leg.sine - kR, -p.x * leg.sine + p.y * leg.cosine - kS, p.z};
}

/// The leg's equation, left side less right side, and its derivatives.
struct Closure {
  double error_m2;
  Vec3d by_position;  ///< gradient in (x, y, z)
  double by_angle;
};

Closure closure(const Vec3d& p, double theta, const Leg& leg) noexcept {
  const LegPoint at = in_leg(p, leg);
  const double cosine = std::cos(theta);
  const double sine = std::sin(theta);
  const double reach_u = at.u + kC - kA * cosine;
  const double reach_w = at.w - kA * sine;
  const double reach = std::sqrt(reach_u * reach_u + reach_w * reach_w);
  const double in_plane = reach - kDPlusE;
  const double sideways = at.v + kF;
  const double by_u = 2 * in_plane * reach_u / reach;
  const double by_v = 2 * sideways;
  const double by_w = 2 * in_plane * reach_w / reach;
  return {in_plane * in_plane + sideways * sideways - kB * kB,
          {by_u * leg.cosine - by_v * leg.sine, by_u * leg.sine + by_v * leg.cosine, by_w},
          kA * (by_u * sine - by_w * cosine)};
}

bool is_finite(const Vec3d& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// x of rows x = b by Cramer's rule; not finite where the rows are dependent.
Vec3d solve(const Mat3d& m, const Vec3d& b) noexcept {
  const Vec3d c01 = cross(m.row0, m.row1);
  const Vec3d c12 = cross(m.row1, m.row2);
  const Vec3d c20 = cross(m.row2, m.row0);
  const double scale = 1.0 / dot(m.row0, c12);
  return scale * (b.x * c12 + b.y * c20 + b.z * c01);
}

}  // namespace

JointAngles angles_of(const EncoderCounts& counts) noexcept {
  JointAngles theta{};
  for (std::size_t i = 0; i < 3; ++i) {
    theta[i] = kRadPerDegree * (kDegreesPerCount * counts[i] + kZeroAngle_deg);
  }
  return theta;
}

EncoderCounts counts_of(const JointAngles& theta_rad) noexcept {
  constexpr double kMost = std::numeric_limits<std::int16_t>::max();
  EncoderCounts counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double count = (theta_rad[i] / kRadPerDegree - kZeroAngle_deg) / kDegreesPerCount;
    counts[i] = static_cast<std::int16_t>(std::clamp(std::round(count), -kMost, kMost));
  }
  return counts;
}

bool inverse(const Vec3d& position_m, JointAngles& out) noexcept {
  JointAngles theta{};
  for (std::size_t i = 0; i < 3; ++i) {
    const LegPoint at = in_leg(position_m, kLegs[i]);
    const double sideways = at.v + kF;
    const double q = kDPlusE + std::sqrt(kB * kB - sideways * sideways);
    const double u = at.u + kC;
    // A chain of two links, a and q, in the plane of u and w; by the half angle of theta.
    const double l0 = at.w * at.w + (u - kA) * (u - kA) - q * q;
    const double l1 = -4 * kA * at.w;
    const double l2 = at.w * at.w + (u + kA) * (u + kA) - q * q;
    theta[i] = 2 * std::atan((-l1 - std::sqrt(l1 * l1 - 4 * l0 * l2)) / (2 * l2));
    if (!std::isfinite(theta[i])) return false;
  }
  out = theta;
  return true;
}

bool forward(const JointAngles& theta_rad, Vec3d& out_m) noexcept {
  Vec3d p = kStart_m;
  double worst_m2 = 0;
  for (int step = 0; step <= kNewtonSteps; ++step) {
    const Closure c0 = closure(p, theta_rad[0], kLegs[0]);
    const Closure c1 = closure(p, theta_rad[1], kLegs[1]);
    const Closure c2 = closure(p, theta_rad[2], kLegs[2]);
    worst_m2 = std::max({std::abs(c0.error_m2), std::abs(c1.error_m2), std::abs(c2.error_m2)});
    if (step == kNewtonSteps) break;  // the last round only judges
    p -= solve({c0.by_position, c1.by_position, c2.by_position},
               {c0.error_m2, c1.error_m2, c2.error_m2});
  }
  if (!is_finite(p) || !(worst_m2 < kArrived_m2)) return false;
  out_m = p;
  return true;
}

bool jacobian(const Vec3d& position_m, const JointAngles& theta_rad, Mat3d& out) noexcept {
  std::array<Vec3d, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Closure c = closure(position_m, theta_rad[i], kLegs[i]);
    rows[i] = (-1.0 / c.by_angle) * c.by_position;
    if (!is_finite(rows[i])) return false;
  }
  out = {rows[0], rows[1], rows[2]};
  return true;
}

bool torques_of(const Vec3d& force_N, const Mat3d& jacobian, Vec3d& out_Nm) noexcept {
  const Vec3d torque = solve(transpose(jacobian), force_N);
  if (!is_finite(torque)) return false;
  out_Nm = torque;
  return true;
}

MotorValues motor_values(const Vec3d& torque_Nm) noexcept {
  if (!is_finite(torque_Nm)) return {};
  const double most =
      std::max({std::abs(torque_Nm.x), std::abs(torque_Nm.y), std::abs(torque_Nm.z)});
  const double scale = -std::min(kMotorValuePerNm, kMaxMotorValue / most);
  const auto value = [scale](double torque) {
    return static_cast<std::int16_t>(std::lround(scale * torque));
  };
  return {value(torque_Nm.x), value(torque_Nm.y), value(torque_Nm.z)};
}

}  // namespace palpate::hal::falcon
