// SPDX-License-Identifier: Apache-2.0
// The surface of one body as contacts see it: closest points, normals of faces, edges and vertices.
//
// Coordinates: the body's own, origin at its centre, in units of the pair (levels::PairState).
#pragma once

#include <cstdint>

#include "rt_core/geometry/vec3.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::contact {

/// Farther than anything, in units.
inline constexpr double kAnywhere = 1e18;
/// Times this, what is computed in double is a bound from above.
inline constexpr double kRoomForRounding = 1 + 1e-9;

/// An image at the scale of a pair. The image has the region engine's sections.
struct Surface {
  const ImageView* image = nullptr;
  double scale = 1;  ///< units of an image coordinate
};

/// Whether the surface has borders.
inline bool is_open(const Surface& surface) noexcept {
  const auto flag = static_cast<std::uint32_t>(image::HeaderFlag::open);
  return (surface.image->header->flags & flag) != 0;
}
/// A point is inside an open surface only up to this depth, in the surface's units.
inline double open_depth(const Surface& surface) noexcept { return 0.1 * surface.scale; }

/// Where on a triangle a closest point lies.
enum class Feature : std::uint8_t { face, edge0, edge1, edge2, corner0, corner1, corner2 };

constexpr bool is_edge(Feature f) noexcept { return f >= Feature::edge0 && f <= Feature::edge2; }
constexpr bool is_corner(Feature f) noexcept { return f >= Feature::corner0; }
/// Which edge or corner, 0 to 2.
constexpr std::uint32_t which(Feature f) noexcept {
  return (static_cast<std::uint32_t>(f) + 2) % 3;
}

/// The point of a triangle that is closest to some point.
struct Foot {
  Vec3d point{};
  double squared = 0;  ///< distance to it
  std::uint32_t triangle = image::kNone;
  Feature feature = Feature::face;
};

Vec3d corner(const Surface& surface, std::uint32_t triangle, std::uint32_t i) noexcept;
Vec3d position(const Surface& surface, std::uint32_t vertex) noexcept;

/// Closest point of a triangle (Ericson 2005, Sec. 5.1.5).
Foot closest_point(const Surface& surface, std::uint32_t triangle, Vec3d x) noexcept;

/// Unit normal of a face; 0 of a sliver, whose normal is rounding.
Vec3d face_normal(const Surface& surface, std::uint32_t triangle) noexcept;

/// Its sign tells inside from outside (Baerentzen and Aanaes 2005). Not of unit length; 0 on the
/// borders of an open surface and where a surface crosses itself, which have no inside.
Vec3d pseudonormal(const Surface& surface, const Foot& foot) noexcept;

/// The direction of a set of normals that is nearest to another direction.
struct NearestNormal {
  Vec3d normal{};
  double cosine = -1;  ///< of the angle between the two
};

/// Of the arc between two unit normals.
NearestNormal nearest_on_arc(Vec3d direction, Vec3d from, Vec3d to) noexcept;
/// Of the spherical convex hull of the normals of a vertex's faces.
NearestNormal nearest_at_vertex(const Surface& surface, std::uint32_t vertex,
                                Vec3d direction) noexcept;
/// Of the face, edge or vertex on which a foot lies.
/// @param direction  unit
NearestNormal nearest_at(const Surface& surface, const Foot& foot, Vec3d direction) noexcept;

std::uint32_t vertex_of(const Surface& surface, std::uint32_t triangle, std::uint32_t i) noexcept;
/// The triangle across the edge from corner `side` to the next; kNone: border.
std::uint32_t neighbour_of(const Surface& surface, std::uint32_t triangle,
                           std::uint32_t side) noexcept;

/// An edge with the normals of the faces on both sides. An edge's name is 3 * triangle + side.
struct Edge {
  Vec3d from{};
  Vec3d to{};
  Vec3d normal{};        ///< of the named triangle
  Vec3d other_normal{};  ///< of its neighbour; the same where there is none
  bool convex = false;   ///< the neighbour folds away by more than 1e-4 rad
  bool concave = false;  ///< it folds up by more than 1e-4 rad
};
Edge edge_of(const Surface& surface, std::uint32_t name) noexcept;

/// Normals of the faces beside a vertex's concave edges.
std::span<const image::SurfaceNormal> concave_normals(const Surface& surface,
                                                      std::uint32_t vertex) noexcept;

inline Vec3d direction(const image::SurfaceNormal& n) noexcept { return vec3d(n.xyz); }

/// A cone that holds a set of normals.
struct NormalCone {
  Vec3d axis{};
  double cosine = -1;  ///< of its half angle; -1: all directions
};
NormalCone cone_of_vertex(const Surface& surface, std::uint32_t vertex) noexcept;
NormalCone cone_of_edge(const Edge& edge) noexcept;

}  // namespace palpate::contact
