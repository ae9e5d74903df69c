// SPDX-License-Identifier: GPL-3.0-or-later
// Surface convex decomposition (Sec. 4.3; Ehmann and Lin 2001).
#pragma once

#include <cstdint>
#include <vector>

#include "host_bake/base/error.hpp"
#include "host_bake/hull/hull.hpp"
#include "host_bake/mesh/check.hpp"
#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// A convex patch and its hull.
struct Patch {
  std::vector<std::uint32_t>
      faces;  ///< of the mesh, ascending; every face belongs to exactly one patch
  std::vector<std::uint32_t> vertices;  ///< of the mesh: hull vertices first (in the order of
                                        ///< hull.vertices), then the others
  HullMesh hull;  ///< hull.vertices are indices into `vertices`: 0, 1, 2, ... (see above)
  std::vector<std::array<std::uint32_t, 3>>
      virtual_faces;       ///< hull faces that the patch does not cover; local indices
  bool all_real = false;   ///< no virtual faces
  bool back_open = false;  ///< of a component that is open or crosses itself
};

/// Divides the surface into patches that meet the three convexity constraints of Sec. 4.3:
///  1. interior edges are convex or flat (exact predicate on the float vertices);
///  2. no vertex of a patch is strictly above the plane of a face of the patch (exact);
///  3. no face of the mesh enters the hull's interior (shrunk by kShrink_rel = 1e-7), and a patch
///     whose hull has no interior is a convex polygon without virtual area: neither cuts nor lids.
///     Polygons may miss kShrink_rel at their border, where rounding bends straight lines.
/// Grown from the faces farthest from any reflex or boundary edge (cresting breadth-first search of
/// Ehmann and Lin 2001); not one face at a time but one plate, see plates.hpp, so that planes can
/// be grown over. Faces without area join the plate on which they lie, or stay alone. A hull facet
/// that the patch covers in part is virtual; of a flat patch both sides are real. Faces in
/// report.crossing_faces are patches of their own; patches of components that are open or cross
/// themselves have at most image::kMaxOpenPatchTriangles faces. Safe for meshes that check()
/// refuses, as long as the report is of the mesh: edges that are not manifold count as boundary.
/// Deterministic whatever the number of threads; one is used. `progress` hears the stage
/// "decompose". Scans take 4 to 6 us a triangle, large smooth patches that end at others up to
/// 20 us; about n^1.5 for one convex patch of n triangles (0.3 s for 100,000).
std::vector<Patch> decompose(const NormalMesh& mesh, const CheckReport& report, unsigned threads,
                             const Progress& progress);

}  // namespace palpate::bake
