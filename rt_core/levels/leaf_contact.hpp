// SPDX-License-Identifier: Apache-2.0
// What two leaf pieces contribute: a contact on the surfaces, or nothing.
#pragma once

#include <cstdint>

#include "rt_core/convex/distance.hpp"
#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/body_pair.hpp"

namespace palpate::levels {

/// In the coordinates of a, lengths in units.
struct LeafContact {
  bool found = false;
  double distance = 0;     ///< signed; the witnesses are this far apart
  double lower_bound = 0;  ///< of the true signed distance of the two patches
  double upper_bound = 0;  ///< likewise
  double share = 1;        ///< Contact::share
  Vec3d point_a{};
  Vec3d point_b{};
  Vec3d normal{};             ///< unit, from b to a
  std::uint32_t queries = 0;  ///< convex queries spent beyond the caller's
  bool interrupted = false;   ///< most_queries ended the search: something nearer may be left
  bool capped = false;        ///< an iteration cap was met: [lower_bound, distance] is an interval
  bool hidden_a = false;      ///< not found: a's hull is nearest where it is inside the solid, and
                              ///< tells nothing of a's surface
  bool hidden_b = false;
};

/// Turns the answer of a convex query of two leaf pieces into a contact.
///
/// Disjoint hulls: the witnesses are a contact where both lie on the mesh. A witness on a virtual
/// face lies inside the solid, behind surface that is nearer to the other body and has its own
/// piece: the pair contributes nothing (the paper leaves this open). Of simplified pieces that
/// piece may be of a level at which its surface ends elsewhere, so they are not where refinement
/// may stop (hidden_a, hidden_b). Pieces of open or self-crossing components have no inside; there
/// the triangles of the patch are queried one by one instead of the hull. Overlapping hulls:
/// penetration depth (Appendix B, step 2b). Departure from the paper: a contact counts as much as
/// both patches face along its normal (facing.hpp), because the shortest way out of a thin piece is
/// often through its back, and pieces that have passed through each other are nearest back to back.
/// @param query         the result for the hulls of a and b
/// @param reach         only contacts nearer than this are wanted
/// @param most_queries  to spend on triangles; beyond that the contact may not be the nearest
/// Cost: no query beyond the caller's for closed meshes; else at most kMaxOpenPatchTriangles^2
/// queries, of which all but a few are told apart by their extents. Penetration: see convex/. Where
/// witnesses are told from virtual faces, O(triangles of both patches).
LeafContact leaf_contact(const PairState& pair, const image::Piece& a, const image::Piece& b,
                         const convex::Distance& query, const convex::Cache& cache, double reach,
                         std::uint32_t most_queries, convex::PenetrationScratch& scratch) noexcept;

}  // namespace palpate::levels
