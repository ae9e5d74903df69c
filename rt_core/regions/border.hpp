// SPDX-License-Identifier: Apache-2.0
// Where a region ends beside a nearer place: its nearest point there is none of the surface.
#pragma once

#include <cstdint>

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::regions {

/// A place on a surface.
struct Place {
  const ImageView& image;
  std::uint32_t triangle;
  Vec3d point;  ///< image coordinates, on the triangle
};

/// How fast the distance falls as a point goes on over the surface from its triangle's border.
struct Fall {
  double rate = 0;                      ///< 0 to 1: of the steepest way on, length per length
  std::uint32_t region = image::kNone;  ///< where that leads
};

/// The steepest way that leads from a point into another region. rate is 0 where the point is not
/// on the border of its region, and where the distance does not fall across it: where it is the
/// nearest of all around it. Only triangles that visit_around() finds count.
/// @param direction  unit, image coordinates: the way in which distance grows
/// O(kMostAround) (around.hpp)
[[nodiscard]] Fall fall_across(const Place& place, Vec3d direction) noexcept;

/// The normal of b's surface that is, the other way round, also one of a's, or as nearly as b's go.
/// On a face a surface has one normal, on an edge those between its two faces', on a corner those
/// that all ways over it lead away from. Turns the direction off the ways over a and over b by
/// turns, until it stays or eight times, and is continuous in it to a microradian. Stays what it is
/// where either place is on a face, or where this would turn it by more than 60 degrees; from 45 on
/// it turns less.
/// @param b_in_a  turns b's coordinates into those of a, which the directions are in
/// @param normal  unit, from b to a: one of b's
/// @return unit
/// O(kMostAround)
[[nodiscard]] Vec3d common_normal(const Place& a, const Place& b, const Mat3d& b_in_a,
                                  Vec3d normal) noexcept;

}  // namespace palpate::regions
