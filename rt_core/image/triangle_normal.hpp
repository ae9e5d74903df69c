// SPDX-License-Identifier: Apache-2.0
// Corners and normal of a stored triangle; the baker and the engine agree on it.
#pragma once

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate::image {

/// @param i  0 to 2
inline Vec3d corner_of(const RegionTriangle& t, std::uint32_t i) noexcept {
  return vec3d(t.corners + 3 * i);
}

/// Heights that rounding may make of nothing, squared, for radius 1: corners are off by up to 6e-8.
inline constexpr double kThin2 = 1e-12;

/// Outward unit normal; 0 of a sliver: so thin that the rounding of its corners decides where it
/// faces.
inline Vec3d normal_of(const RegionTriangle& t) noexcept {
  const Vec3d a = corner_of(t, 0);
  const Vec3d ab = corner_of(t, 1) - a;
  const Vec3d ac = corner_of(t, 2) - a;
  const Vec3d normal = cross(ab, ac);
  const double area2 = squared_norm(normal);
  const double ab2 = squared_norm(ab);
  const double ac2 = squared_norm(ac);
  const double bc2 = squared_norm(ac - ab);
  const double longer2 = ab2 > ac2 ? ab2 : ac2;
  const double longest2 = bc2 > longer2 ? bc2 : longer2;
  if (!(area2 > kThin2 * longest2)) return {};
  return (1 / sqrt_of(area2)) * normal;
}

}  // namespace palpate::image
