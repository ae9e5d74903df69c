// SPDX-License-Identifier: GPL-3.0-or-later
// The tree of convex pieces while it is being made (Sec. 4.4): level 0 from the patches, further
// levels put on top of it, one root in the end. Levels are only ever added above the pieces that
// have no parent yet: simplified levels first, then the free ones of merge_to_root().
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "host_bake/decompose/decompose.hpp"
#include "host_bake/hull/hull.hpp"
#include "host_bake/mesh/mesh.hpp"
#include "host_bake/simplify/simplify.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {

/// A convex piece. Its indices into `vertices` are called local.
struct TreePiece {
  /// Level at which it was made. It lives until the level below its parent's.
  std::uint32_t level = 0;
  /// Into Hierarchy::pieces; kNone at the root, and while nothing is above.
  std::uint32_t parent = image::kNone;
  /// Into Hierarchy::pieces, ascending; empty on level 0.
  std::vector<std::uint32_t> children;
  /// Into Hierarchy::points: hull vertices, then the patch's others; no repeats.
  std::vector<std::uint32_t> vertices;
  /// The first ones of `vertices`.
  std::uint32_t hull_vertices = 0;
  /// Of the hull, as in HullMesh: faces without area make straight ones.
  int dimension = 3;
  /// Local, as in HullMesh::faces.
  std::vector<std::array<std::uint32_t, 3>> hull_faces;
  /// Into Hierarchy::points, ascending: the extreme points of all descendants of level 0. Empty
  /// where they are the hull vertices: on level 0 and on free levels.
  std::vector<std::uint32_t> enclosing;

  // Of the patch, as in Patch; empty and false on free levels.
  std::vector<image::Triangle> triangles;  ///< local; `source` counts in the mesh of its level
  std::vector<std::array<std::uint32_t, 3>> virtual_faces;  ///< local
  bool all_real = false;
  bool back_open = false;
};

/// A level of detail: the pieces alive at it.
struct TreeLevel {
  std::uint32_t pieces = 0;
  std::uint32_t triangles = 0;  ///< 0 on free levels
  bool free = false;            ///< made by hull merging alone
  float resolution = 0;         ///< r, for radius 1; 0 on free levels
};

struct Hierarchy {
  std::vector<PointF> points;     ///< the mesh's first, at their indices there; then each level's
  std::vector<TreePiece> pieces;  ///< children before parents; the root is the last one
  std::vector<TreeLevel> levels;  ///< finest first
};

using PiecePair = std::pair<std::uint32_t, std::uint32_t>;  ///< first < second

/// A hierarchy of level 0 alone, one piece a patch, in the order of the patches. `resolution` is
/// that of the level (finest_resolution() of metrics). O(size of the patches).
Hierarchy level_zero(const NormalMesh& mesh, const std::vector<Patch>& patches, float resolution);

/// Puts a simplified level on top of the pieces that have no parent: those of the level before it,
/// in the order of its patches. Every patch becomes a piece; choose_parents() says whose. Parallel;
/// the same whatever the number of threads. O(n log n) in the extreme points of the pieces.
void add_level(Hierarchy& tree, const SimplifiedLevel& level);

/// The extreme points of a piece's descendants of level 0, into Hierarchy::points.
std::span<const std::uint32_t> enclosing_points(const TreePiece& piece);

/// The pieces that have no parent, ascending.
std::vector<std::uint32_t> top_pieces(const Hierarchy& tree);

/// One side of a triangle, and whose.
struct OwnedSide {
  std::uint32_t low, high;  ///< its vertices
  std::uint32_t owner;
  auto operator<=>(const OwnedSide&) const = default;
};

/// Pairs of owners that have a side in common, ascending, each once. O(n log n).
std::vector<PiecePair> owners_that_meet(std::vector<OwnedSide> sides);

/// Pairs of positions in `pieces` whose triangles share an edge, ascending, each once. O(n log n)
/// in the triangles.
std::vector<PiecePair> edge_neighbours(const Hierarchy& tree,
                                       const std::vector<std::uint32_t>& pieces);

/// Positions of points of the tree.
std::vector<PointF> positions(const Hierarchy& tree, std::span<const std::uint32_t> points);

/// Positions of a piece's hull vertices.
std::vector<PointF> hull_points(const Hierarchy& tree, const TreePiece& piece);

/// The hull of everything that the children have below them, and its extreme points as indices into
/// Hierarchy::points, ascending.
struct EnclosingHull {
  HullMesh hull;
  std::vector<std::uint32_t> points;
};
EnclosingHull enclosing_hull(const Hierarchy& tree, std::span<const std::uint32_t> children);

}  // namespace palpate::bake
