// SPDX-License-Identifier: Apache-2.0
// The curve in which two surfaces cross: where an overlap is, and which way leads out of it.
#pragma once

#include <cstdint>

#include "rt_core/levels/body_pair.hpp"

namespace palpate::regions {

/// Sums over the segments in which pairs of triangles cross, in the coordinates of a, lengths in
/// units. A pair begins and ceases to cross with a segment of no length, and where the curve passes
/// from one pair to the next, one segment grows by what the other loses: all sums are continuous in
/// the poses, however a surface is cut.
struct CrossingCurve {
  double length = 0;
  Vec3d moment{};  ///< length times middle
  /// The two ways out that the surfaces tell: length times a's inward normal, and b's outward one.
  /// A triangle that may have been met from its back (is_closed()) does not count.
  Vec3d along_a{};
  Vec3d along_b{};
};

/// Adds the segment of two triangles (indices into region_triangles). Nothing where they do not
/// cross, lie in one plane, or one has no area. O(1)
void add_segment(const levels::PairState& pair, std::uint32_t triangle_a, std::uint32_t triangle_b,
                 CrossingCurve& curve) noexcept;

}  // namespace palpate::regions
