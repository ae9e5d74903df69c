// SPDX-License-Identifier: Apache-2.0
// The triangles that meet in a point of the surface.
#pragma once

#include <cstdint>

#include "rt_core/image/view.hpp"
#include "rt_core/regions/region_triangle.hpp"

namespace palpate::regions {

/// Vertices of more triangles are looked at as far as that.
inline constexpr std::uint32_t kMostAround = 64;

/// A triangle that holds a point, and the ways on over it from there: counter-clockwise from one
/// direction to the other. Those may be of any length.
struct Sector {
  std::uint32_t triangle = image::kNone;
  Vec3d from{};
  Vec3d to{};
};

/// On which corner or edge of its triangle a point lies.
struct Feature {
  enum class Kind : std::uint8_t { face, edge, corner } kind = Kind::face;
  std::uint32_t index = 0;  ///< the corner; of an edge the corner it starts at
};

/// @param point  image coordinates, on the triangle
[[nodiscard]] inline Feature feature_at(const image::RegionTriangle& t, Vec3d point) noexcept {
  // Of the triangle's longest edge: so near to an edge is on it. Points come from floats.
  constexpr double kOnEdge = 1e-4;
  const Vec3d corners[3] = {corner(t, 0, 1), corner(t, 1, 1), corner(t, 2, 1)};
  double longest2 = 0;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const double length2 = squared_norm(corners[(i + 1) % 3] - corners[i]);
    longest2 = length2 > longest2 ? length2 : longest2;
  }
  const double near2 = kOnEdge * kOnEdge * longest2;
  Feature found;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Vec3d edge = corners[(i + 1) % 3] - corners[i];
    const Vec3d offset = point - corners[i];
    if (squared_norm(offset) <= near2) return {Feature::Kind::corner, i};
    if (squared_norm(cross(edge, offset)) <= near2 * squared_norm(edge)) {
      found = {Feature::Kind::edge, i};
    }
  }
  return found;
}

/// The edge of a triangle that it shares with another; kNone where it has none.
[[nodiscard]] inline std::uint32_t edge_to(const image::RegionTriangle& t,
                                           std::uint32_t neighbour) noexcept {
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (t.neighbours[i] == neighbour) return i;
  }
  return image::kNone;
}

/// Calls visit(Sector) for every other triangle that holds a point of `triangle`: the one across
/// its edge, or those around its corner, each way up to a border of the surface.
/// @param point  image coordinates, on the triangle
/// O(kMostAround)
template <typename Visit>
void visit_around(const ImageView& image, std::uint32_t triangle, Vec3d point,
                  Visit visit) noexcept {
  const Feature at = feature_at(image.region_triangles[triangle], point);
  if (at.kind == Feature::Kind::face) return;
  std::uint32_t left = kMostAround;
  for (const bool onwards : {true, false}) {
    std::uint32_t here = triangle;
    std::uint32_t at_corner = at.index;
    while (left > 0) {
      const image::RegionTriangle& t = image.region_triangles[here];
      const std::uint32_t next = t.neighbours[onwards ? at_corner : (at_corner + 2) % 3];
      if (next == image::kNone) break;
      if (next == triangle) return;
      const image::RegionTriangle& n = image.region_triangles[next];
      const std::uint32_t shared = edge_to(n, here);
      if (shared == image::kNone) break;
      const Vec3d start = corner(n, shared, 1);
      const Vec3d end = corner(n, (shared + 1) % 3, 1);
      if (at.kind == Feature::Kind::edge) {
        visit(Sector{next, end - start, start - end});
        return;
      }
      at_corner = onwards ? (shared + 1) % 3 : shared;
      const Vec3d apex = corner(n, at_corner, 1);
      visit(Sector{next, corner(n, (at_corner + 1) % 3, 1) - apex,
                   corner(n, (at_corner + 2) % 3, 1) - apex});
      here = next;
      --left;
    }
  }
}

}  // namespace palpate::regions
