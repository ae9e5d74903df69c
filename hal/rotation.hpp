// SPDX-License-Identifier: Apache-2.0
// Rotations as vectors: the exponential map and its inverse. Host code: uses libm.
#pragma once

#include "rt_core/geometry/pose.hpp"

namespace palpate::hal {

/// The rotation by |v| radians about v.
[[nodiscard]] Quat rotation_from_vector(Vec3d rotation_rad) noexcept;

/// The shortest rotation that a unit quaternion stands for, as a vector of length at most pi (rad).
[[nodiscard]] Vec3d vector_from_rotation(const Quat& q) noexcept;

/// The rotation that leads from one orientation to another, as a vector in world axes (rad).
[[nodiscard]] Vec3d rotation_between(const Quat& from, const Quat& to) noexcept;

/// Scaled to unit length; a zero quaternion becomes the identity.
[[nodiscard]] Quat normalised(const Quat& q) noexcept;

}  // namespace palpate::hal
