// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/surface_edge.hpp"

#include <cmath>

#include "rt_core/image/format.hpp"
#include "rt_core/image/triangle_normal.hpp"

namespace palpate::bake {
namespace {

/// The corner of a neighbour that is not of the edge.
Vec3d opposite_corner(const image::RegionTriangle& t, Vec3d from, Vec3d to) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Vec3d p = image::corner_of(t, i);
    if (!(p == from) && !(p == to)) return p;
  }
  return from;  // of a triangle without area
}

}  // namespace

Bend bend_of(std::span<const image::RegionTriangle> triangles, std::uint32_t side) {
  const image::RegionTriangle& t = triangles[side / 3];
  const std::uint32_t across = t.neighbours[side % 3];
  if (across == image::kNone) return Bend::flat;
  const Vec3d mine = image::normal_of(t);
  const Vec3d other = image::normal_of(triangles[across]);
  if (squared_norm(mine) == 0 || squared_norm(other) == 0) return Bend::flat;
  const Vec3d from = image::corner_of(t, side % 3);
  const Vec3d to = image::corner_of(t, (side + 1) % 3);
  const double above = dot(mine, opposite_corner(triangles[across], from, to) - from);
  const double angle = std::atan2(norm(cross(mine, other)), dot(mine, other));
  if (above < 0 && angle > image::kConvexEdgeAngle) return Bend::convex;
  if (above > 0 && angle > image::kConcaveEdgeAngle) return Bend::concave;
  return Bend::flat;
}

}  // namespace palpate::bake
