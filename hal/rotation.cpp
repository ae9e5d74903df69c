// SPDX-License-Identifier: Apache-2.0
#include "hal/rotation.hpp"

#include <cmath>

namespace palpate::hal {

Quat rotation_from_vector(Vec3d rotation_rad) noexcept {
  const double angle = norm(rotation_rad);
  // sin(x / 2) / x by its series below this angle, where the quotient loses digits; the rest is
  // under 1e-17.
  constexpr double kSmallAngle = 1e-4;
  const double scale =
      angle < kSmallAngle ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), scale * rotation_rad.x, scale * rotation_rad.y,
          scale * rotation_rad.z};
}

Vec3d vector_from_rotation(const Quat& q) noexcept {
  // q and -q are the same rotation; the one with w >= 0 is the short way round.
  const double sign = q.w < 0 ? -1.0 : 1.0;
  const Vec3d axis{sign * q.x, sign * q.y, sign * q.z};
  const double sine = norm(axis);
  constexpr double kSmallSine = 1e-12;
  const double scale = sine < kSmallSine ? 2.0 : 2.0 * std::atan2(sine, sign * q.w) / sine;
  return scale * axis;
}

Vec3d rotation_between(const Quat& from, const Quat& to) noexcept {
  return vector_from_rotation(to * Quat{from.w, -from.x, -from.y, -from.z});
}

Quat normalised(const Quat& q) noexcept {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (length == 0) return {};
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

}  // namespace palpate::hal
