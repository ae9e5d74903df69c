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
  /// Length times a mean of b's outward normal and a's inward one, nearly all to the one along
  /// which the two triangles part sooner: so a corner or a side in a face is pushed along the
  /// face's normal from the beginning on, as it was before it crossed. A triangle that may have
  /// been met from its back (is_closed()) does not count.
  Vec3d out{};
};

/// Adds the segment of two triangles (indices into region_triangles). Nothing where they do not
/// cross, lie in one plane, or one has no area. O(1)
void add_segment(const levels::PairState& pair, std::uint32_t triangle_a, std::uint32_t triangle_b,
                 CrossingCurve& curve) noexcept;

}  // namespace palpate::regions
