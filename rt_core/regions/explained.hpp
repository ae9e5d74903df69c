// SPDX-License-Identifier: Apache-2.0
// Which contacts of unknown direction cannot change a push.
#pragma once

#include "rt_core/contact/facing.hpp"
#include "rt_core/force/least_push.hpp"

namespace palpate::regions {

/// Least push over all directions within an angle of an axis, or less.
/// @param axis  unit  @param cosine, sine  of the angle, 0 to pi
inline double least_in_cone(const force::Push& push, Vec3d axis, double cosine,
                            double sine) noexcept {
  const double size2 = squared_norm(push.vector);
  const double along = dot(axis, push.vector);
  const double size = sqrt_of(size2);
  const double across2 = size2 - along * along;
  const double across = across2 > 0 ? sqrt_of(across2) : 0;
  const bool opposed = along <= -size * cosine;
  const double linear = opposed ? -size : along * cosine - across * sine;
  if (cosine <= 0) return linear;
  const double root = sqrt_of(push.squeeze_along(axis) > 0 ? push.squeeze_along(axis) : 0);
  const double trace = push.trace();
  const double quadratic = root * cosine - sqrt_of(trace > 0 ? trace : 0) * sine;
  return linear + (quadratic > 0 ? quadratic * quadratic : 0);
}

/// The largest strength of a contact that cannot change the push. Its direction is within
/// kMostTilt_rad of a cone of normals, and it is weaker the more it tilts from them.
/// @param axis    of the cone, as a push  @param cosine  of its half angle; -1: all directions
/// @param share   1: of the push itself; less: of this share of it
inline double explained(const force::Push& push, Vec3d axis, double cosine, double share) noexcept {
  const auto counted = [&](double pushed) {
    return share < 1 ? (pushed > 0 ? share * pushed : 0) : pushed;
  };
  const double anywhere = counted(-norm(push.vector));
  if (cosine <= -1) return anywhere;
  constexpr int kSteps = 3;
  // Of 15, 30 and 45 degrees.
  constexpr double kCosine[kSteps] = {0.96592582628906831, 0.86602540378443865,
                                      0.70710678118654752};
  constexpr double kSine[kSteps] = {0.25881904510252074, 0.5, 0.70710678118654752};
  const double sine = sqrt_of(cosine * cosine < 1 ? 1 - cosine * cosine : 0);
  double least = 1e300;
  for (int i = 0; i < kSteps; ++i) {
    const double c = cosine * kCosine[i] - sine * kSine[i];
    const double s = sine * kCosine[i] + cosine * kSine[i];
    // Beyond 180 degrees the cone is everything.
    const double pushed = s < 0 ? anywhere : counted(least_in_cone(push, axis, c, s));
    // A contact that has faded to a part of its strength is explained by that part.
    const double whole = pushed > 0 ? pushed * kSteps / (kSteps - i) : pushed;
    least = whole < least ? whole : least;
  }
  return least;
}

}  // namespace palpate::regions
