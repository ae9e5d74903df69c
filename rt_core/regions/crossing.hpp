// SPDX-License-Identifier: Apache-2.0
// How deep a region whose triangles cross the other body's has entered it.
#pragma once

#include <cstdint>

#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/search.hpp"

namespace palpate::regions {

/// Working memory of one query at a time; needs no initialisation.
struct CrossingScratch {
  convex::PenetrationScratch polytope;
  CrossingList list;
};

/// In the coordinates of a, lengths in units. Moving a by depth * normal parts the two pieces.
struct Crossing {
  double depth = -1;
  Vec3d point_a{};
  Vec3d point_b{};
  Vec3d normal{};
  std::uint32_t piece_a = 0;
  std::uint32_t piece_b = 0;
  bool exact = true;
};

/// The deepest overlap of the pairs of pieces in scratch.list, which is not empty.
///
/// Depth and direction are those of convex pieces of the original surface, as in the levels engine.
/// They go to zero as the triangles part, and a pair that joins the list joins it with none. Cost:
/// one penetration query a pair.
Crossing deepest(const levels::PairState& pair, CrossingScratch& scratch) noexcept;

}  // namespace palpate::regions
