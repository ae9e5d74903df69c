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

/// The angle that a sector takes up, 0 to pi, to 1e-4 (Abramowitz and Stegun 1964, 4.4.45: the arc
/// cosine by a square root).
[[nodiscard]] inline double angle_of(const Sector& s) noexcept {
  constexpr double kHalfTurn = 3.14159265358979323846;
  const double size = sqrt_of(squared_norm(s.from) * squared_norm(s.to));
  const double cosine = size > 0 ? dot(s.from, s.to) / size : 1;
  const double c = cosine < 0 ? -cosine : cosine;
  const double series = 1.5707288 + c * (-0.2121144 + c * (0.0742610 - 0.0187293 * c));
  const double angle = sqrt_of(c < 1 ? 1 - c : 0) * series;
  return cosine < 0 ? kHalfTurn - angle : angle;
}

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
  double least2 = near2;
  Feature found;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Vec3d edge = corners[(i + 1) % 3] - corners[i];
    const Vec3d offset = point - corners[i];
    if (squared_norm(offset) <= near2) return {Feature::Kind::corner, i};
    // Between the long edges of a needle both are near.
    const double length2 = squared_norm(edge);
    const double off2 = length2 > 0 ? squared_norm(cross(edge, offset)) / length2 : 0;
    if (off2 <= least2) {
      least2 = off2;
      found = {Feature::Kind::edge, i};
    }
  }
  return found;
}

/// A triangle across an edge, and which of its edges that is there.
struct Across {
  std::uint32_t triangle = image::kNone;  ///< kNone: border of the surface
  std::uint32_t edge = 0;
};

[[nodiscard]] inline Across across(const ImageView& image, std::uint32_t triangle,
                                   std::uint32_t edge) noexcept {
  const std::uint32_t next = image.region_triangles[triangle].neighbours[edge];
  if (next == image::kNone) return {};
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (image.region_triangles[next].neighbours[i] == triangle) return {next, i};
  }
  return {};  // adjacency is not proved where an image is loaded
}

/// The ways over a triangle from a corner or an edge of it.
[[nodiscard]] inline Sector sector_at(const ImageView& image, std::uint32_t triangle,
                                      Feature at) noexcept {
  const image::RegionTriangle& t = image.region_triangles[triangle];
  const Vec3d start = corner(t, at.index, 1);
  const Vec3d from = corner(t, (at.index + 1) % 3, 1) - start;
  if (at.kind == Feature::Kind::edge) return {triangle, from, -from};
  return {triangle, from, corner(t, (at.index + 2) % 3, 1) - start};
}

/// Calls visit(Sector) for every other triangle that holds a feature of `triangle`: the one across
/// its edge, or those around its corner, each way up to a border of the surface and kMostAround in
/// all.
/// O(kMostAround)
template <typename Visit>
void visit_around(const ImageView& image, std::uint32_t triangle, Feature at,
                  Visit visit) noexcept {
  if (at.kind == Feature::Kind::face) return;
  if (at.kind == Feature::Kind::edge) {
    const Across next = across(image, triangle, at.index);
    if (next.triangle == image::kNone) return;
    visit(sector_at(image, next.triangle, {Feature::Kind::edge, next.edge}));
    return;
  }
  std::uint32_t left = kMostAround;
  for (const bool onwards : {true, false}) {
    std::uint32_t here = triangle;
    std::uint32_t apex = at.index;
    for (; left > 0; --left) {
      const Across next = across(image, here, onwards ? apex : (apex + 2) % 3);
      if (next.triangle == image::kNone) break;
      if (next.triangle == triangle) return;
      here = next.triangle;
      apex = onwards ? (next.edge + 1) % 3 : next.edge;
      visit(sector_at(image, here, {Feature::Kind::corner, apex}));
    }
  }
}

/// The same for a point.
/// @param point  image coordinates, on the triangle
template <typename Visit>
void visit_around(const ImageView& image, std::uint32_t triangle, Vec3d point,
                  Visit visit) noexcept {
  visit_around(image, triangle, feature_at(image.region_triangles[triangle], point), visit);
}

}  // namespace palpate::regions
