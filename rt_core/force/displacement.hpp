// SPDX-License-Identifier: Apache-2.0
// From one pose to another, as a twist times one second.
#pragma once

#include "rt_core/geometry/matrix6.hpp"

namespace palpate::force {

/// World axes; the linear part is the way of the origin. The angle is 2 sin(angle / 2), the shorter
/// way round, which needs no arc functions and is 1 % low at half a radian. Unit quaternions.
inline Vec6 displacement(const Pose& from, const Pose& to) noexcept {
  const Quat& f = from.orientation;
  const Quat q = to.orientation * Quat{f.w, -f.x, -f.y, -f.z};
  const double twice = q.w < 0 ? -2 : 2;
  return vec6(to.position_m - from.position_m, twice * Vec3d{q.x, q.y, q.z});
}

}  // namespace palpate::force
