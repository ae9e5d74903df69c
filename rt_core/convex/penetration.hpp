// SPDX-License-Identifier: Apache-2.0
// Penetration depth of two overlapping convex hulls.
#pragma once

#include "rt_core/convex/distance.hpp"
#include "rt_core/convex/polytope.hpp"

namespace palpate::convex {

/// In the coordinates of a.
struct Penetration {
  double depth = 0;        ///< >= 0; moving a by depth * normal separates the hulls
  double lower_bound = 0;  ///< of the depth, >= 0; equals depth to kDistanceAccept where exact
  Vec3d normal{};          ///< unit, from b to a
  Vec3d point_a{};         ///< deepest point of a inside b
  Vec3d point_b{};         ///< point_b - point_a = depth * normal
  bool exact = true;       ///< false: a cap was met; depth and normal still separate the hulls
};

/// Working memory of one query at a time, about 26 KB; needs no initialisation.
struct PenetrationScratch {
  Polytope polytope;
};

/// Depth and direction of the least translation that separates a and b (expanding polytope, van den
/// Bergen 2001, with fixed arrays). Called after distance() answered penetrating or touching;
/// starts from its cache.
///
/// Departures: faces have signed offsets, so that the polytope need not hold the origin; every
/// direction looked at bounds the depth from above by the hulls' own extent along it, so that
/// whatever ends the search, the answer separates; of the triangles that a face of a - b is made
/// of, the points come from the one that the origin projects into, so that rounding does not choose
/// them.
///
/// Never fails: flat and identical hulls, concentric hulls and one hull inside another give a
/// finite depth and a unit normal; where the cap is met the answer is the best separating
/// translation seen, exact = false. Where a - b is flat to kTouching (coplanar flat hulls) the
/// depth is at most that and the normal theirs; where it is straight, the normal is one across it.
/// The depth is continuous as the hulls move. The normal and the points leap where another way out
/// becomes the shortest.
/// Cost: at most kMaxPolytopeVertices + 12 support pairs, O(kMaxPolytopeFaces) each. Real-time
/// safe.
[[nodiscard]] Penetration penetration(const Hull& a, const Hull& b, const RelativePose& b_in_a,
                                      const Cache& cache, PenetrationScratch& scratch) noexcept;

}  // namespace palpate::convex
