// SPDX-License-Identifier: Apache-2.0
// How deep a region whose triangles cross the other body's has entered it.
#pragma once

#include <cstdint>

#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/search.hpp"

namespace palpate::regions {

/// Pairs of pieces that cross, of one region at a time.
inline constexpr std::uint32_t kMaxCrossings = 16;

/// Working memory of one query at a time; needs no initialisation.
struct CrossingScratch {
  convex::PenetrationScratch polytope;
  std::uint32_t piece_a[kMaxCrossings];
  std::uint32_t piece_b[kMaxCrossings];
};

/// In the coordinates of a, lengths in units. Moving a by depth * normal parts the two pieces.
struct Crossing {
  double depth = 0;
  Vec3d point_a{};
  Vec3d point_b{};
  Vec3d normal{};
  std::uint32_t piece_a = 0;
  std::uint32_t piece_b = 0;
  bool exact = true;
};

/// The deepest overlap of the convex pieces (level 0) of a pair of triangles that cross.
///
/// Depth and direction are those of convex pieces, as in the levels engine: they go to zero as the
/// triangles part. Cost: one penetration query.
Crossing crossing_of(const levels::PairState& pair, std::uint32_t triangle_a,
                     std::uint32_t triangle_b, CrossingScratch& scratch) noexcept;

}  // namespace palpate::regions
