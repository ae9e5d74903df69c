// SPDX-License-Identifier: Apache-2.0
// Which way the patches of two pieces face, and how squarely they meet.
#pragma once

#include "rt_core/levels/body_pair.hpp"

namespace palpate::levels {

/// A way to part the hulls of a and b, in the coordinates of a: moving a by depth * normal takes
/// point_a out of b.
struct Way {
  Vec3d normal;
  Vec3d point_a;
  double depth = 0;
};

/// Piece::patch_normal: the way a patch faces, in piece coordinates; 0 where that is not told.
inline Vec3d patch_normal(const image::Piece& piece) noexcept { return vec3d(piece.patch_normal); }

/// Is a point of the hull's surface (piece coordinates) on the patch? O(triangles of the patch)
[[nodiscard]] bool on_patch(const ImageView& image, const image::Piece& piece,
                            Vec3d point) noexcept;

/// How squarely two patches meet along a direction from b to a: 1 and more where that lies in the
/// cone of normals of both, less by as much as the cosine falls beyond the cone of the less square.
/// A patch that does not tell which way it faces is met squarely.
[[nodiscard]] double normal_alignment(const PairState& pair, const image::Piece& a,
                                      const image::Piece& b, Vec3d direction) noexcept;

/// Have patches only just met, so that the way the hulls part soonest is the one they came? 1 where
/// they begin to overlap, 0 from a quarter of delta on. Less, and 0 at last, where they meet less
/// squarely than to a quarter: such a way may lead along a surface that goes on. 0 where it leads
/// through virtual faces.
/// Cost: O(triangles of both patches)
[[nodiscard]] double just_met(const PairState& pair, const image::Piece& a, const image::Piece& b,
                              const Way& way) noexcept;

}  // namespace palpate::levels
