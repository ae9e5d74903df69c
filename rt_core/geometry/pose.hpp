// SPDX-License-Identifier: Apache-2.0
// Poses, twists and wrenches, in SI units.
#pragma once

#include "rt_core/geometry/vec3.hpp"

namespace palpate {

/// Unit quaternion, order w x y z.
struct Quat {
  double w = 1, x = 0, y = 0, z = 0;
};

/// Where a body is: maps body coordinates to world coordinates, x_world = R(orientation) x_body +
/// position_m.
struct Pose {
  Vec3d position_m{};
  Quat orientation{};
};

/// Force (N) and torque (N m), in world axes; the torque is about the point that the context names.
struct Wrench {
  Vec3d force_N{};
  Vec3d torque_Nm{};
};

/// Rotation matrix of a unit quaternion (body to world).
inline Mat3d rotation(const Quat& q) noexcept {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)},
          {2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)},
          {2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)}};
}

inline Quat operator*(const Quat& a, const Quat& b) noexcept {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// Rigid map from the coordinates of b to those of a: x_a = rotation x_b + translation. Lengths in
/// the unit of the context.
struct RelativePose {
  Mat3d rotation{};
  Vec3d translation{};
};

}  // namespace palpate
