// SPDX-License-Identifier: Apache-2.0
// Where a region ends beside a nearer place: its nearest point there is none of the surface.
#pragma once

#include <cstdint>

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::regions {

/// How fast the distance falls as a point goes on over the surface from its triangle's border.
struct Fall {
  double rate = 0;                      ///< 0 to 1: of the steepest way on, length per length
  std::uint32_t region = image::kNone;  ///< where that leads
};

/// The steepest way that leads from a point into another region. rate is 0 where the point is not
/// on the border of its region, and where the distance does not fall across it: where it is the
/// nearest of all around it. Only triangles that visit_around() finds count.
/// @param point      image coordinates, on the triangle
/// @param direction  unit: the way in which distance grows
/// O(kMostAround) (around.hpp)
[[nodiscard]] Fall fall_across(const ImageView& image, std::uint32_t triangle, Vec3d point,
                               Vec3d direction) noexcept;

}  // namespace palpate::regions
