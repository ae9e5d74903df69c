// SPDX-License-Identifier: Apache-2.0
// What the stored triangle of a region says of the surface there.
#pragma once

#include <cstdint>

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::regions {

/// @param i  0 to 2  @param scale  of the body's coordinates (levels::PairState)
inline Vec3d corner(const image::RegionTriangle& t, std::uint32_t i, double scale) noexcept {
  return scale * Vec3d{static_cast<double>(t.corners[3 * i]),
                       static_cast<double>(t.corners[3 * i + 1]),
                       static_cast<double>(t.corners[3 * i + 2])};
}

/// Lengths that rounding may make of nothing, squared, of the body's radius: corners are off by up
/// to 6e-8.
inline constexpr double kThin2 = 1e-12;

/// Outward, of twice the triangle's area, in image coordinates. 0 of a sliver: so thin that the
/// rounding of its corners decides where it faces.
inline Vec3d normal_of(const image::RegionTriangle& t) noexcept {
  constexpr double kMostLength2 = 9;
  const Vec3d p = corner(t, 0, 1);
  const Vec3d to_next = corner(t, 1, 1) - p;
  const Vec3d to_last = corner(t, 2, 1) - p;
  const Vec3d normal = cross(to_next, to_last);
  const double area2 = squared_norm(normal);
  if (area2 > kThin2 * kMostLength2) return normal;  // as most are, whatever their length
  const double next2 = squared_norm(to_next);
  const double last2 = squared_norm(to_last);
  const double opposite2 = squared_norm(to_last - to_next);
  const double longer2 = next2 > last2 ? next2 : last2;
  const double longest2 = opposite2 > longer2 ? opposite2 : longer2;
  return area2 > kThin2 * longest2 ? normal : Vec3d{};
}

/// Part of an edge or a corner of the surface around it, and none of a face.
inline bool is_sliver(const image::RegionTriangle& t) noexcept {
  return squared_norm(normal_of(t)) == 0;
}

/// False where the surface may have been met from its back: it is open, or may cross itself there.
/// Of what crosses itself somewhere, triangles that do are pieces of their own (docs/FORMAT.md).
inline bool is_closed(const ImageView& image, const image::RegionTriangle& t) noexcept {
  const auto open = static_cast<std::uint32_t>(image::HeaderFlag::open);
  const auto back_open = static_cast<std::uint32_t>(image::PieceFlag::back_open);
  const image::Piece& piece = image.pieces[t.piece];
  const bool may_cross = (piece.flags & back_open) != 0 && piece.triangles == 1;
  return (image.header->flags & open) == 0 && !may_cross;
}

}  // namespace palpate::regions
