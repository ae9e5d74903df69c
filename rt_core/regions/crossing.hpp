// SPDX-License-Identifier: Apache-2.0
// How deep a region whose triangles cross the other body's has entered it.
#pragma once

#include <cstdint>

#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/search.hpp"

namespace palpate::regions {

/// In the coordinates of a, lengths in units: point_b - point_a = depth * normal.
struct Crossing {
  double depth = -1;
  Vec3d point_a{};
  Vec3d point_b{};
  Vec3d normal{};
  std::uint32_t piece_a = 0;
  std::uint32_t piece_b = 0;
  bool exact = true;
};

/// Two pieces that cross in a region.
struct CrossingOfPieces {
  Crossing overlap;       ///< its depth as it counts along the region's normal, after overlap()
  Vec3d way{};            ///< out, as long as their part of the curve says it surely; 0: not told
  double part = 0;        ///< of the region's depth: 0 where others are deeper
  double way_length = 0;  ///< how far they have to move along the region's normal until they part;
                          ///< 0: no part, or they only touch
};

/// Working memory of one query at a time; needs no initialisation.
struct CrossingScratch {
  convex::PenetrationScratch polytope;
  CrossingList list;
  CrossingOfPieces of_pieces[kMaxCrossings];  ///< [list.count] after overlap()
};

/// The overlap of a region whose list is not empty: as deep as the deepest of the pairs of pieces
/// that are led out nearly the same way, about the middle of the curve in which the surfaces cross
/// and in the direction in which it leads out.
///
/// Depths are those of convex pieces of the original surface, as in the levels engine; they go to
/// zero as the pieces part. The directions that these are least in are of no use: a piece of a
/// detailed surface is often thinner than the overlap is deep, so that its other side is nearer,
/// and where two ways are equally long the least turns at once. It is taken only where the normals
/// along the curve cancel, as of a blade that has passed through a wall, or where both surfaces may
/// have been met from their backs. Else each pair of pieces is led out along the normals of a or of
/// b along their part of the curve, nearly all along those by which the pieces part sooner, and the
/// region in the mean direction: so a corner or a side in a face is pushed along the face's normal
/// from the beginning on, as it was before it crossed, however large the triangles are. So is an
/// edge that crosses an edge: where the surfaces have only just met (levels/facing.hpp) and the
/// curve is short, the least way out of the pieces is the way they came, and counts.
/// Cost: one penetration query and up to six support points a pair, and its patches' triangles
/// where it has only just met.
Crossing overlap(const levels::PairState& pair, CrossingScratch& scratch) noexcept;

}  // namespace palpate::regions
