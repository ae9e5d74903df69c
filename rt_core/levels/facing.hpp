// SPDX-License-Identifier: Apache-2.0
// What of two pieces is surface, and how much their surfaces face each other.
#pragma once

#include "rt_core/levels/body_pair.hpp"

namespace palpate::levels {

/// Is a point of the hull's surface (piece coordinates) on the patch? O(triangles of the patch)
[[nodiscard]] bool on_patch(const ImageView& image, const image::Piece& piece,
                            Vec3d point) noexcept;

/// How much two patches face each other along a direction, 0 to 1: the cosine of the angle between
/// it and the nearest normal of the patch that faces it less; 0 from a right angle on, 1 where no
/// patch tells which way it faces (Piece::patch_normal). Departure from contacts of surfaces, which
/// fade by 45 degrees (contact::facing): the cone of a patch holds its own faces alone, so that a
/// sharp corner is met farther from all of them. O(1)
/// @param direction  unit, from b to a, in the coordinates of a
[[nodiscard]] double facing(const PairState& pair, const image::Piece& a, const image::Piece& b,
                            Vec3d direction) noexcept;

}  // namespace palpate::levels
