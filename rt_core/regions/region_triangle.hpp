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

/// Outward, of twice the triangle's area, in image coordinates.
inline Vec3d normal_of(const image::RegionTriangle& t) noexcept {
  const Vec3d p = corner(t, 0, 1);
  return cross(corner(t, 1, 1) - p, corner(t, 2, 1) - p);
}

/// False where the surface may have been met from its back: it is open, or crosses itself.
inline bool is_closed(const ImageView& image, const image::RegionTriangle& t) noexcept {
  const auto open = static_cast<std::uint32_t>(image::HeaderFlag::open);
  const auto back_open = static_cast<std::uint32_t>(image::PieceFlag::back_open);
  return (image.header->flags & open) == 0 && (image.pieces[t.piece].flags & back_open) == 0;
}

}  // namespace palpate::regions
