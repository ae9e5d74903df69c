// SPDX-License-Identifier: Apache-2.0
// Records of the region engine's sections: a wide tree over the original triangles, and regions of
// the surface. docs/FORMAT.md specifies them for readers in other languages.
//
// Lengths are for radius 1, relative to the object's centre, as everywhere in an image.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::image {

inline constexpr std::uint32_t kRegionWidth = 16;     ///< children of a node, at most
inline constexpr std::uint32_t kMaxRegionDepth = 16;  ///< nodes on a path from the root to a leaf
inline constexpr std::uint32_t kMaxRegionNodes = 1u << 27;  ///< so that a child has a 32-bit name
inline constexpr std::uint32_t kMaxRegions = 1u << 16;

/// A node of the wide tree: a box about each child, component by component, so that one box is
/// tested against all children at once. Nodes lie in breadth-first order.
///
/// Box of child i: every point x of a triangle below it has |axis_k . (x - centre)| <= half[k][i]
/// in exact arithmetic on these floats. The axes are orthonormal to kBoxAxisTolerance. Boxes beyond
/// the last child repeat the first one's.
struct RegionNode {
  float centre[3][kRegionWidth];
  float axes[9][kRegionWidth];  ///< component c of axis k in row 3 k + c
  float half[3][kRegionWidth];  ///< half the box's lengths, >= 0
  std::uint32_t first;         ///< first child: into region_triangles for a leaf, else region_nodes
  std::uint32_t children;      ///< 1 to kRegionWidth, contiguous
  std::uint32_t leaf;          ///< 1: children are triangles
  std::uint32_t parent;        ///< kNone at the root
  std::uint32_t region;        ///< the region that it is part of; kNone above the regions
  std::uint32_t first_region;  ///< the regions below it, contiguous; its own one inside a region
  std::uint32_t regions;       ///< at least 1
  std::uint32_t reserved[9];
};
static_assert(sizeof(RegionNode) == 1024);
inline constexpr float kBoxAxisTolerance = 1e-6f;

/// A triangle of the source mesh, one cache line. Triangles lie in the order of the leaves.
struct RegionTriangle {
  float corners[9];             ///< x y z of each corner, counter-clockwise seen from outside
  std::uint32_t neighbours[3];  ///< triangle across the edge from corner i to i + 1; kNone: border
  std::uint32_t region;
  std::uint32_t piece;   ///< the piece of level 0 whose patch holds it
  std::uint32_t source;  ///< index in the source mesh; each once
  /// The first triangle of the component of the surface that it is of, which comes before it. At
  /// that one itself: the first one of the next component, which comes after it; kNone at the last.
  /// 0 throughout where there is one component (component.hpp).
  std::uint32_t component;
};
static_assert(sizeof(RegionTriangle) == 64);

/// A connected or nearly connected part of the surface for which the engine keeps one least
/// distance.
struct Region {
  std::uint32_t parent;  ///< node above its root ...
  std::uint32_t slot;    ///< ... and which child of it the root is
  float reach;           ///< farthest point from the object's centre, rounded up
  float radius;          ///< half the diagonal of its root's box, rounded up
};
static_assert(sizeof(Region) == 16);

inline constexpr std::uint32_t kBrickEdge = 4;  ///< cells
inline constexpr std::uint32_t kBrickCells = kBrickEdge * kBrickEdge * kBrickEdge;
inline constexpr std::uint32_t kCoarseBrick = 0x80000000u;
inline constexpr std::uint32_t kMaxBricksAcross = 1024;  ///< along each axis

/// A grid of cells about the object, each of which names the triangle nearest to its centre: where
/// to look first for what is near a point, and a bound of its distance. validate() asks only that
/// what it names exists; that it is the nearest is proved by `palpate inspect --verify`.
///
/// Cells are in bricks of kBrickEdge cubed. A brick near the surface is fine: its number is that of
/// its first cell in proximity_cells over kBrickCells. Any other is one triangle, plus
/// kCoarseBrick.
struct ProximityGrid {
  float origin[3];          ///< the corner of least coordinates
  float cell;               ///< edge of a cell, > 0
  std::uint32_t bricks[3];  ///< along each axis, 1 to kMaxBricksAcross
  std::uint32_t reserved;
};
static_assert(sizeof(ProximityGrid) == 32);

/// A vertex of the baked surface: all corners with one position.
struct SurfaceVertex {
  float position[3];
  /// Unit: face normals weighted by their angles here (Baerentzen and Aanaes 2005); 0 where they
  /// cancel, on borders, and of faces that cross others.
  float pseudonormal[3];
  std::uint32_t first_normal;  ///< into vertex_normals
  /// Corners of the spherical convex hull of its faces' normals, counter-clockwise seen from
  /// outside; 0: they lie in no hemisphere, the hull is the whole sphere.
  std::uint16_t hull_normals;
  std::uint16_t concave_normals;  ///< after those: distinct normals of faces beside concave edges
};
static_assert(sizeof(SurfaceVertex) == 32);

/// A unit normal.
struct SurfaceNormal {
  float xyz[3];
};
static_assert(sizeof(SurfaceNormal) == 12);

/// Vertices and edges that belong to a region: vertices to that of their first triangle, edges to
/// that of the triangle that names them; and the cone of the normals of its faces.
struct SurfaceRun {
  std::uint32_t first_vertex;  ///< into surface_vertices
  std::uint32_t vertices;
  std::uint32_t first_edge;  ///< into surface_edges
  std::uint32_t edges;
  float normal[3];  ///< axis, unit, of a cone that holds them; 0 where none is narrower than a half
                    ///< space
  float normal_cos;  ///< cosine of its half angle, rounded down by 1e-6; -1 without an axis
};
static_assert(sizeof(SurfaceRun) == 32);

/// Vertices of a region triangle, corner by corner.
struct TriangleVertices {
  std::uint32_t corner[3];  ///< into surface_vertices
};
static_assert(sizeof(TriangleVertices) == 12);

// Which normals and edges a baker keeps. Faces that are slivers (triangle_normal.hpp) have no
// normal, and the edges beside them are neither convex nor concave.
inline constexpr double kEqualNormalCos = 1 - 1e-10;  ///< nearer normals count as one
inline constexpr double kConvexEdgeAngle = 1e-4;      ///< rad; convex edges turn by more
inline constexpr double kConcaveEdgeAngle = 1e-4;     ///< rad; concave edges turn by more

/// So that an edge has a 32-bit name.
inline constexpr std::uint32_t kMaxRegionTriangles = 0xffffffffu / 3;

}  // namespace palpate::image
