// SPDX-License-Identifier: Apache-2.0
// What of two pieces is surface, and how much their surfaces face each other.
#pragma once

#include "rt_core/levels/body_pair.hpp"

namespace palpate::levels {

/// Is a point of the hull's surface (piece coordinates) on the patch? O(triangles of the patch)
[[nodiscard]] bool on_patch(const ImageView& image, const image::Piece& piece,
                            Vec3d point) noexcept;

/// How much two patches face each other along a direction from b to a: the cosine of the angle
/// between that and the nearest normal of the patch that faces it less, 0 beyond a right angle. A
/// patch that does not tell which way it faces counts wholly.
[[nodiscard]] double facing(const PairState& pair, const image::Piece& a, const image::Piece& b,
                            Vec3d direction) noexcept;

}  // namespace palpate::levels
