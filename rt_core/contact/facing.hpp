// SPDX-License-Identifier: Apache-2.0
// The fades of the contact definition (docs/CONTACT.md): how much a direction and a set of normals
// agree, and how much a way out counts beside a shorter one.
#pragma once

#include "rt_core/contact/surface.hpp"
#include "rt_core/geometry/angle.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::contact {

/// Directions farther from a surface's normals do not count.
inline constexpr double kMostTilt_rad = kPi / 4;
inline constexpr double kLeastTiltCosine = 0.70710678118654752;
/// Ways out that are this many times as long as the nearest do not count.
inline constexpr double kMostDetour = 3;

/// Contacts fade out between delta and this many delta.
inline constexpr double kReach = 1.25;

/// 1 up to delta, 0 from kReach on.
inline double within_reach(double distance, double delta) noexcept {
  return clamp01((kReach - distance / delta) / (kReach - 1));
}

/// How much a point inside counts: wholly, but behind an open surface it fades from half of the
/// depth on from which it is outside.
inline double solidity(const Surface& surface, double depth) noexcept {
  return is_open(surface) ? clamp01(2 - 2 * depth / open_depth(surface)) : 1;
}

/// 1 at angle 0, falling in proportion to the angle to 0 at kMostTilt_rad.
inline double facing(double cosine) noexcept {
  if (cosine >= 1) return 1;
  if (cosine <= kLeastTiltCosine) return 0;
  return clamp01(1 - arc_cosine(cosine) / kMostTilt_rad);
}

/// 1 for the surface nearest to a point inside, 0 for surface kMostDetour times as far away.
/// @param depth  of the point, >= 0  @param distance  from it, >= 0
inline double directness(double depth, double distance) noexcept {
  if (!(distance > 0)) return 1;
  return clamp01((kMostDetour * depth / distance - 1) / (kMostDetour - 1));
}

}  // namespace palpate::contact
