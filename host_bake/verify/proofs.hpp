// SPDX-License-Identifier: GPL-3.0-or-later
// The proofs of verify(), one function an invariant. "Exact" means decided by exact predicates on
// the float coordinates. Tolerances are for radius 1.
#pragma once

#include "host_bake/verify/evidence.hpp"

namespace palpate::bake {

/// Sec. 4.3, constraint 1: no edge between two triangles of a patch is reflex (exact), and the two
/// run through it in opposite directions. O(n log n).
Proof prove_interior_edges_convex(const Evidence& evidence);

/// Sec. 4.3, constraint 2: no vertex of a piece lies above the plane of a triangle of its patch
/// (exact). O(triangles * valence).
Proof prove_no_vertex_visible(const Evidence& evidence);

/// Sec. 4.3, constraint 3: on every level that has a mesh, none of its triangles enters the
/// interior of the solid hull of another patch, shrunk by kIntrusionTolerance.
Proof prove_no_intrusion(const Evidence& evidence);
inline constexpr double kIntrusionTolerance = 1e-7 * (1 + 1e-3);  // decompose()'s, and rounding

/// Triangles of the patch and virtual faces together cover each solid hull: all lie on its surface
/// (exact) and their areas add up to no less than its own, to 1e-9 of it and kIntrusionTolerance
/// along its edges: where vertices of the surface lie on a straight edge, rounding bends it inward
/// (decompose()). A flat hull needs no virtual faces.
Proof prove_hulls_covered(const Evidence& evidence);

/// The patch normal is the mean of the normals of the triangles, and the cosine their least (to
/// 1e-6).
Proof prove_patch_normals(const Evidence& evidence);

/// The hull vertices are the extreme points of the piece's vertices (exact).
Proof prove_hull_vertices_extreme(const Evidence& evidence);

/// Neighbour lists hold every edge of the hull, are mutual, and hold nothing else but diagonals of
/// its facets (exact).
Proof prove_adjacency(const Evidence& evidence);

/// Every hull vertex is inside its piece's sphere (exact).
Proof prove_spheres_contain(const Evidence& evidence);

/// Every triangle of the source mesh is in exactly one piece of level 0, and so, by the tree, of
/// every level.
Proof prove_sources_complete(const Evidence& evidence);

/// Every level that has a mesh is an oriented manifold like the original one, and no more of its
/// faces cross (exact; check() on each).
Proof prove_levels_are_surfaces(const Evidence& evidence);

// What is measured against the original surface can only be proved where the image holds it; an
// image without (dropped_levels > 0) says so in `found`.

/// A hull of a free level encloses all pieces of level 0 below it (exact).
Proof prove_free_levels_enclose(const Evidence& evidence);

/// No piece of level 0 is farther than h outside the hull of a piece above it, nor farther than the
/// residual outside its culling hull (to 1e-9).
Proof prove_hausdorff_bounds(const Evidence& evidence);

/// No point of a dense sample of a patch (15 a triangle) is farther than s from the original
/// surface (to 1e-9; CGAL's AABB tree).
Proof prove_deviation_bounds(const Evidence& evidence);

/// s is 0 on the original surface and never less at a piece than at its children on levels with a
/// mesh.
Proof prove_deviation_ordered(const Evidence& evidence);

/// Levels with a mesh come first, the coarser the smaller r, which is positive; free levels have
/// r = 0; each piece has the r of its level.
Proof prove_resolution_ordered(const Evidence& evidence);

/// D > 0 at every vertex.
Proof prove_support_areas_positive(const Evidence& evidence);

/// Every triangle of level 0 is in the wide tree once, with the same corners and its own piece.
Proof prove_region_triangles(const Evidence& evidence);

/// A triangle of the wide tree and its neighbour run through their common edge in opposite
/// directions.
Proof prove_region_neighbours(const Evidence& evidence);

// What contacts see of the surface (region_format.hpp). Bounds derived from how the sections are
// made and stored are beside the proofs.

/// Every corner of a triangle is at its vertex, to the bit; triangles beside an edge share its two
/// vertices. Every vertex is of a triangle, and in the run of the region of its first one.
Proof prove_surface_vertices(const Evidence& evidence);

/// The hull of a vertex holds the normal of every face at it; its corners are such normals, and all
/// are on the left of all its arcs, so that the engine's way to the nearest direction is right.
/// Vertices without a hull have normals that lie in no half space.
Proof prove_vertex_hulls(const Evidence& evidence);

/// Pseudonormals are the normals of the faces weighted by their angles; 0 on borders and where they
/// cancel.
Proof prove_pseudonormals(const Evidence& evidence);

/// Concave normals of a vertex are the normals of the faces beside its concave edges, each once.
Proof prove_concave_normals(const Evidence& evidence);

/// The edges of a region are the convex ones of its triangles, each under the first of its two,
/// ascending; the runs of the regions follow one another.
Proof prove_surface_edges(const Evidence& evidence);

/// The cone of a region holds the normals of its faces, exactly as stored, and is no wider than
/// they need. Regions without a cone have normals that lie in no half space.
Proof prove_region_cones(const Evidence& evidence);

/// The triangle that a cell names is the nearest to its centre, as the engine computes both, and
/// the grid holds the surface. O((cells + triangles) log triangles)
Proof prove_proximity(const Evidence& evidence);

}  // namespace palpate::bake
