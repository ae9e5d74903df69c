// SPDX-License-Identifier: Apache-2.0
// The memory image, format version 2.0: what lies where. docs/FORMAT.md specifies it for readers in
// other languages; this header is its C++ form and the only place that knows the layout.
//
// Little-endian; fixed-width types; every section starts on a 64-byte boundary; offsets count bytes
// from the start of the image; no pointers. Geometry is relative to the object's centre and divided
// by its radius: x_body_m = centre_m + radius_m * v.
//
// One layout for one content: the sections lie in the order of their slots, each at the first
// 64-byte boundary after the end of the one before (the first at sizeof(Header)); total_bytes is
// the end of the last one rounded up to 64; padding is zero. Inside a section the runs of the
// pieces lie in the order of the pieces, without gaps: a piece's run starts where the one of the
// piece before it ended. validate() proves all of this.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::image {

inline constexpr std::uint8_t kMagic[8] = {0x89, 'P', 'A', 'L', 'P', '\r', '\n', 0x1a};
inline constexpr std::uint16_t kFormatMajor = 3;  ///< another major number is refused
inline constexpr std::uint16_t kFormatMinor = 0;  ///< a newer minor number still loads
inline constexpr std::uint32_t kByteOrderMark = 0x01020304;
inline constexpr std::size_t kAlignment = 64;
inline constexpr std::uint32_t kNone = 0xffffffffu;  ///< "no such index"

// What the engine can walk. The baker stays below; validate() refuses what is above.

/// Also the greatest depth: a child's level is below its parent's.
inline constexpr std::uint32_t kMaxLevels = 64;
inline constexpr std::uint32_t kMaxPieces = 1u << 24;
inline constexpr std::uint32_t kMaxChildren = 4096;  ///< children of one piece
inline constexpr std::uint32_t kMaxHullVertices = 1u << 22;
/// Triangles of a patch whose back side can be reached.
inline constexpr std::uint32_t kMaxOpenPatchTriangles = 16;
/// Hulls with more vertices than this carry neighbour lists.
inline constexpr std::uint32_t kAdjacencyAbove = 32;
/// Culling hulls have no neighbour lists, so they stay this small.
inline constexpr std::uint32_t kMaxCullingVertices = kAdjacencyAbove;

// Ranges of numbers; lengths and areas for radius 1.
inline constexpr double kMinRadius_m = 1e-12;
inline constexpr double kMaxRadius_m = 1e12;
inline constexpr double kMaxCentre_m = 1e15;  ///< of each |coordinate|
/// Of a vertex and of a sphere's centre. The original lies in the unit ball (to 1e-5); simplified
/// vertices may leave it, for they keep the volume.
inline constexpr float kMaxNorm = 1.5f;
inline constexpr float kMaxLength = 4.0f;  ///< of a sphere's radius, s, h and delta
/// Of a support area: the least normal float, so that 1 / D is finite.
inline constexpr float kMinArea = 1.17549435e-38f;
inline constexpr float kMaxArea = 1e9f;

/// A run of equal records. An empty section's slot is all zero.
struct Section {
  std::uint64_t offset;  ///< bytes from the start of the image, a multiple of 64
  std::uint32_t count;   ///< records
  std::uint32_t stride;  ///< bytes a record
};

enum class SectionId : std::uint32_t {
  levels = 0,  ///< Level, finest first
  /// Piece; the root is piece 0, children follow their parent, siblings are contiguous
  pieces = 1,
  vertices = 2,  ///< Vertex; each piece's own run
  /// u32; hull_vertices + 1 a piece with adjacency, offsets into neighbours from the piece's own
  /// first one
  neighbour_starts = 3,
  /// u32; vertex indices local to the piece, strictly ascending within a list, no list empty
  neighbours = 4,
  triangles = 5,      ///< Triangle; the patch of each piece of a level that is not free
  virtual_faces = 6,  ///< VirtualFace; hull faces that are not of the mesh
  /// Vertex, with support_area 0; culling hulls of the pieces whose own hull is no tight bound
  culling_vertices = 7,
  // The region engine's (region_format.hpp): all three or none.
  region_nodes = 8,      ///< RegionNode, breadth first
  region_triangles = 9,  ///< RegionTriangle; the source mesh in the order of the leaves
  regions = 10,          ///< Region
  // Where to look first: all three, with those of the regions, or none.
  proximity_grid = 11,    ///< ProximityGrid; one
  proximity_bricks = 12,  ///< u32; x fastest
  proximity_cells = 13,   ///< u32, into region_triangles; kBrickCells a fine brick, x fastest
  // What contacts see of the surface: all, with those of the regions, or none. A surface may be
  // without convex edges.
  surface_vertices = 14,   ///< SurfaceVertex, region by region
  vertex_normals = 15,     ///< SurfaceNormal; each vertex's own run
  surface_edges = 16,      ///< u32, 3 * triangle + side; convex edges, region by region
  surface_runs = 17,       ///< SurfaceRun; of each region
  triangle_vertices = 18,  ///< TriangleVertices; of each region triangle
  // 19 and 20 are for later minor versions; they are empty so far.
};
inline constexpr std::size_t kSectionSlots = 21;

enum class HeaderFlag : std::uint32_t {
  repaired = 1u << 0,       ///< the source was repaired before baking
  open = 1u << 1,           ///< the source has boundary edges: source_boundary_edges > 0
  self_crossing = 1u << 2,  ///< faces of the source cross one another: source_crossings > 0
  grown_support = 1u << 3,  ///< support areas are of faces grown within delta, not of the 1-ring
};

struct Header {
  std::uint8_t magic[8];
  std::uint16_t format_major;
  std::uint16_t format_minor;
  std::uint32_t byte_order_mark;
  std::uint32_t header_bytes;  ///< sizeof(Header)
  std::uint32_t flags;         ///< HeaderFlag
  std::uint64_t total_bytes;   ///< of the whole image

  std::uint8_t content_sha256[32];  ///< of the whole image with these 32 bytes zero
  std::uint8_t source_sha256[32];   ///< of the source mesh file as it was read

  double centre_m[3];  ///< the object's centre in body coordinates
  double radius_m;     ///< of the smallest sphere about centre_m that holds every vertex

  std::uint32_t source_triangles;  ///< of the mesh that was baked (welded, repaired where asked)
  std::uint32_t source_vertices;
  std::uint32_t source_components;
  std::uint32_t source_boundary_edges;
  std::uint32_t source_crossings;  ///< pairs of faces that cross
  std::uint32_t reserved0;

  float delta_rel;  ///< contact tolerance that the metrics were made for, relative to the radius
  float stop_resolution;      ///< bake stop rule: least resolution r, 0 where unused
  float stop_deviation_rel;   ///< bake stop rule: largest surface deviation s, 0 where unused
  std::uint32_t stop_pieces;  ///< bake stop rule: fewest pieces, 0 where unused
  float s0_min;               ///< smallest threshold of eq. 7 that this image serves (0: any)
  float partner_area;         ///< smallest support area of partners that this image serves (0: any)

  // What an engine must have room for.
  std::uint32_t free_levels;          ///< how many of the levels are free (the last ones)
  std::uint32_t tree_depth;           ///< pieces on the longest path from the root to a leaf
  std::uint32_t max_children;         ///< of one piece
  std::uint32_t max_hull_vertices;    ///< of one piece
  std::uint32_t max_patch_triangles;  ///< of one piece
  std::uint32_t max_valence;          ///< longest neighbour list
  std::uint32_t leaf_pieces;          ///< pieces of level 0
  /// Finest levels that were left out, the original surface with them; 0: level 0 is the original
  /// surface. With s0_min and partner_area, what the image still serves.
  std::uint32_t dropped_levels;
  /// No point of the surface that was baked is farther than this from the mesh of source_sha256,
  /// nor the other way round, relative to the radius: detail may be left out before baking. 0: it
  /// is that mesh. What engines prove holds of the surface baked; their certificates add this.
  float source_deviation_rel;
  std::uint32_t reserved1;

  Section sections[kSectionSlots];
  std::uint8_t reserved2[24];
};
static_assert(sizeof(Header) == 576);
static_assert(offsetof(Header, content_sha256) == 32);
static_assert(offsetof(Header, centre_m) == 96);
static_assert(offsetof(Header, sections) == 216);

/// One level of detail (Sec. 4.4). A piece belongs to every level from Piece::level up to the one
/// below its parent's.
struct Level {
  std::uint32_t pieces;  ///< pieces that belong to this level; 1 on the last
  /// Of the level's mesh (source_triangles on the original surface); 0 on free levels.
  std::uint32_t triangles;
  std::uint32_t free;               ///< 1 where made by hull merging alone (no metric)
  float resolution;                 ///< r, Sec. 4.1, for radius 1; 0 on free levels
  float max_surface_deviation_rel;  ///< largest s of its pieces
  float max_hausdorff_rel;          ///< largest h of its pieces
  float min_support_area_rel;       ///< smallest D of its pieces
  std::uint32_t reserved;
};
static_assert(sizeof(Level) == 32);

enum class PieceFlag : std::uint32_t {
  /// Every hull face is of the mesh: a single triangle, a flat convex patch, a closed convex body.
  /// Set where a piece with a patch has no virtual faces; clear on free levels.
  all_real = 1u << 0,
  /// Its virtual faces can be reached from outside (open or self-crossing component).
  back_open = 1u << 1,
};

/// A convex piece (Sec. 4.3): the hull of a patch, or of its children's hulls on free levels. Two
/// cache lines; what a query reads is in the first.
struct Piece {
  float centre[3];              ///< bounding sphere of the hull
  float radius;                 ///< rounded up: every hull vertex is inside in exact arithmetic
  std::uint32_t first_vertex;   ///< into vertices
  std::uint32_t hull_vertices;  ///< the first ones of its run: extreme points
  std::uint32_t first_child;    ///< into pieces; kNone on level 0
  std::uint32_t children;       ///< 0 on level 0, at least 1 above
  /// into neighbour_starts; kNone where hull_vertices <= kAdjacencyAbove
  std::uint32_t first_neighbour_start;
  std::uint32_t first_neighbour;  ///< into neighbours; kNone likewise
  std::uint32_t flags;            ///< PieceFlag
  std::uint32_t level;            ///< level at which the piece was made; the last level at the root
  /// s, Sec. 4.5: no point of the patch is farther from the original surface
  float surface_deviation;
  /// h, Sec. 4.5: no point of an original descendant is farther outside this hull
  float hausdorff;
  float resolution;        ///< r of its level; 0 on free levels
  float min_support_area;  ///< smallest D of its vertices
  // second line
  std::uint32_t parent;          ///< kNone at the root
  std::uint32_t vertices;        ///< of its run: hull vertices, then the patch's other vertices
  std::uint32_t first_triangle;  ///< into triangles; kNone on free levels
  std::uint32_t triangles;       ///< of its patch; 0 on free levels, at least 1 on others
  /// into virtual_faces; kNone where there are none and on free levels
  std::uint32_t first_virtual_face;
  std::uint32_t virtual_faces;
  /// Of its culling hull, a reduced hull of the original surface below: tighter than the own hull
  /// widened by h, because patches drift while they are simplified. Into culling_vertices; kNone
  /// where the own hull serves.
  std::uint32_t first_culling_vertex;
  std::uint32_t culling_vertices;  ///< 0 likewise, else at most kMaxCullingVertices
  /// No point of an original descendant is farther outside the culling hull; hausdorff where that
  /// is the piece's own.
  float culling_residual;
  /// Mean of the outward normals of the patch's triangles, weighted by their areas: the side it
  /// faces. 0 where it has none: on free levels, where back_open,
  float patch_normal[3];
  float patch_cosine;  ///< least cosine between it and the normal of a triangle; 0 without one
  std::uint32_t reserved[3];
};
static_assert(sizeof(Piece) == 128);

/// A vertex of a piece, with its support area.
struct Vertex {
  float position[3];   ///< relative to the object's centre, divided by its radius
  float support_area;  ///< D, Sec. 4.5, relative to the radius squared
};
static_assert(sizeof(Vertex) == 16);

/// A triangle of a patch, counter-clockwise seen from outside.
struct Triangle {
  std::uint32_t vertices[3];  ///< local to the piece's run
  std::uint32_t source;  ///< index of the triangle in the source mesh; kNone on simplified levels
};
static_assert(sizeof(Triangle) == 16);

/// A triangle of a hull that is not covered by the patch, counter-clockwise seen from outside.
struct VirtualFace {
  std::uint32_t vertices[3];  ///< local to the piece's run
};
static_assert(sizeof(VirtualFace) == 12);

}  // namespace palpate::image
