// SPDX-License-Identifier: Apache-2.0
// The one rule for quaternions in files: order w x y z, of unit length within 1e-3.
#pragma once

#include "rt_core/geometry/pose.hpp"

namespace palpate::config {

inline constexpr double kUnitTolerance = 1e-3;

/// Makes q's length exactly one (up to rounding). False, and q unchanged, where the length is off
/// by more than kUnitTolerance or not finite.
[[nodiscard]] inline bool make_unit(Quat& q) noexcept {
  const double length = sqrt_of(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(length >= 1 - kUnitTolerance && length <= 1 + kUnitTolerance)) return false;
  q = {q.w / length, q.x / length, q.y / length, q.z / length};
  return true;
}

}  // namespace palpate::config
