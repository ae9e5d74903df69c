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
  Vec3d normal{};  ///< see normal_of()
  Vec3d from{};
  Vec3d to{};

  [[nodiscard]] bool is_sliver() const noexcept { return squared_norm(normal) == 0; }
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
    const double area2 = squared_norm(cross(edge, offset));
    if (area2 <= least2 * length2) {
      least2 = length2 > 0 ? area2 / length2 : 0;
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
  const Vec3d normal = normal_of(t);
  if (at.kind == Feature::Kind::edge) return {triangle, normal, from, -from};
  return {triangle, normal, from, corner(t, (at.index + 2) % 3, 1) - start};
}

/// Of the edges of a triangle the one that is nearest to a point.
/// @param but  not this one; 3: any
[[nodiscard]] inline std::uint32_t nearest_edge(const image::RegionTriangle& t, Vec3d point,
                                                std::uint32_t but) noexcept {
  std::uint32_t nearest = 0;
  double least2 = -1;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (i == but) continue;
    const Vec3d start = corner(t, i, 1);
    const Vec3d edge = corner(t, (i + 1) % 3, 1) - start;
    const double length2 = squared_norm(edge);
    const double along = length2 > 0 ? dot(point - start, edge) / length2 : 0;
    const Vec3d off = point - start - (along < 0 ? 0 : along < 1 ? along : 1) * edge;
    if (least2 >= 0 && squared_norm(off) >= least2) continue;
    nearest = i;
    least2 = squared_norm(off);
  }
  return nearest;
}

/// From a triangle that holds a point to what is no sliver: across slivers, one after the other,
/// where they hold it.
/// @param at  the edge is the one that it was reached by; 3: none
/// @return kNone where a border of the surface or kMostAround slivers end the way
[[nodiscard]] inline Across off_slivers(const ImageView& image, Across at, Vec3d point) noexcept {
  for (std::uint32_t left = kMostAround; left > 0 && at.triangle != image::kNone; --left) {
    const image::RegionTriangle& t = image.region_triangles[at.triangle];
    if (!is_sliver(t)) return at;
    at = across(image, at.triangle, nearest_edge(t, point, at.edge));
  }
  return {};
}

/// Where a point lies on the surface.
struct Foot {
  std::uint32_t triangle = image::kNone;
  Feature at;  ///< of the triangle
};

/// @param triangle  holds the point. Of a sliver whose edge or corner does, what is beside it there
///                  is told instead
/// @param point     image coordinates
[[nodiscard]] inline Foot foot_at(const ImageView& image, std::uint32_t triangle,
                                  Vec3d point) noexcept {
  const Foot here{triangle, feature_at(image.region_triangles[triangle], point)};
  if (here.at.kind == Feature::Kind::face) return here;
  const std::uint32_t beside = off_slivers(image, {triangle, 3}, point).triangle;
  if (beside == image::kNone || beside == triangle) return here;
  return {beside, feature_at(image.region_triangles[beside], point)};
}

/// Calls visit(Sector) for every other triangle that holds the feature of a foot: the one across
/// its edge, or those around its corner, each way up to a border of the surface and kMostAround in
/// all. Slivers are gone over as if they were not there.
/// @return false where that has ended it
/// O(kMostAround)
template <typename Visit>
bool visit_around(const ImageView& image, const Foot& foot, Vec3d point, Visit visit) noexcept {
  if (foot.at.kind == Feature::Kind::face) return true;
  if (foot.at.kind == Feature::Kind::edge) {
    const Across next = off_slivers(image, across(image, foot.triangle, foot.at.index), point);
    if (next.triangle == image::kNone || next.triangle == foot.triangle) return true;
    visit(sector_at(image, next.triangle, {Feature::Kind::edge, next.edge}));
    return true;
  }
  std::uint32_t left = kMostAround;
  for (const bool onwards : {true, false}) {
    std::uint32_t here = foot.triangle;
    std::uint32_t apex = foot.at.index;
    for (; left > 0; --left) {
      const Across next = across(image, here, onwards ? apex : (apex + 2) % 3);
      if (next.triangle == image::kNone) break;
      if (next.triangle == foot.triangle) return true;
      here = next.triangle;
      apex = onwards ? (next.edge + 1) % 3 : next.edge;
      const Sector sector = sector_at(image, here, {Feature::Kind::corner, apex});
      if (!sector.is_sliver()) {
        visit(sector);
      } else if (squared_norm(onwards ? sector.from : sector.to) <= kThin2) {
        apex = (apex + (onwards ? 1 : 2)) % 3;
      } else if (dot(sector.from, sector.to) < 0) {  // the corner is on the edge beyond it, too
        const Across over = off_slivers(image, across(image, here, (apex + 1) % 3), point);
        if (over.triangle == image::kNone || over.triangle == foot.triangle) continue;
        visit(sector_at(image, over.triangle, {Feature::Kind::edge, over.edge}));
      }
    }
  }
  return left > 0;
}

}  // namespace palpate::regions
