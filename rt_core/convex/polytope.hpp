// SPDX-License-Identifier: Apache-2.0
// A convex polytope of triangles that grows by one vertex at a time, in fixed arrays.
#pragma once

#include <cstdint>

#include "rt_core/convex/minkowski.hpp"

namespace palpate::convex {

inline constexpr std::uint32_t kMaxPolytopeVertices = 128;
inline constexpr std::uint32_t kMaxPolytopeFaces = 2 * kMaxPolytopeVertices - 4;  // Euler

struct PolytopeFace {
  Vec3d normal{};                  ///< unit, outward
  double offset = 0;               ///< normal . any point of the face
  std::uint16_t vertices[3] = {};  ///< counter-clockwise seen from outside
  std::uint16_t across[3] = {};    ///< face across the edge from vertices[i] to vertices[i + 1]
  bool live = false;
  bool visible = false;  ///< from the vertex being added
};

/// An edge between a face that is visible from the new vertex and one that is not.
struct HorizonEdge {
  std::uint16_t from = 0, to = 0;  ///< in the sense of the visible face
  std::uint16_t outer = 0;         ///< the face that stays
  std::uint16_t outer_edge = 0;    ///< its edge
};

/// About 26 KB. Needs no initialisation beyond start().
struct Polytope {
  std::uint32_t vertex_count = 0;  ///< ever added; inner ones stay in the array
  std::uint32_t face_count = 0;    ///< slots used; look at live
  std::uint32_t free_count = 0;
  std::uint32_t horizon_count = 0;
  DifferencePoint vertices[kMaxPolytopeVertices];
  PolytopeFace faces[kMaxPolytopeFaces];
  std::uint16_t free_faces[kMaxPolytopeFaces] = {};  ///< slots to use again
  std::uint16_t pending[kMaxPolytopeFaces] = {};     ///< of the search for visible faces
  HorizonEdge horizon[kMaxPolytopeVertices];
  std::uint16_t edge_from[kMaxPolytopeVertices] = {};  ///< horizon edge that leaves a vertex
};

/// A tetrahedron; false where its corners are coplanar.
[[nodiscard]] bool start(Polytope& polytope, const DifferencePoint (&corners)[4]) noexcept;

/// The live face with the least offset: the nearest one to the origin where that is inside, else
/// the one it is farthest beyond. O(faces).
[[nodiscard]] std::uint32_t lowest_face(const Polytope& polytope) noexcept;

/// Adds a vertex outside of `face` and closes the polytope around it.
///
/// Faces that see the vertex, or are coplanar with it to `coplanar`, are replaced by a fan. A fan
/// triangle without area takes the plane of its neighbour.
/// @return false where the arrays are full, or rounding has made the horizon something else than
///         one simple loop; the polytope must then not be used any more
/// Cost: O(faces).
[[nodiscard]] bool add_vertex(Polytope& polytope, std::uint32_t face, const DifferencePoint& vertex,
                              double coplanar) noexcept;

}  // namespace palpate::convex
