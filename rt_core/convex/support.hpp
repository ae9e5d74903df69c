// SPDX-License-Identifier: Apache-2.0
// The vertex of a hull that lies farthest in a direction.
#pragma once

#include <cstdint>

#include "rt_core/convex/hull.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::convex {

/// Steps of one climb; a longer one ends in a scan of all vertices. Hulls of some thousand vertices
/// are crossed in under a hundred steps.
inline constexpr std::uint32_t kMaxClimbSteps = 512;

/// A vertex and its dot product with a direction.
struct Farthest {
  std::uint32_t vertex = 0;
  double dot = 0;
};

/// The vertex whose dot product with `direction` is largest.
///
/// Without adjacency (baked hulls up to image::kAdjacencyAbove vertices): a scan of all vertices,
/// ties to the lower index. With it: steepest ascent over hull edges from `start`, ties to the
/// vertex met first. On a convex hull a vertex without a rising edge is a global maximum, coplanar
/// facets or not, so that plateaus need no crossing. Rising is decided from edge vectors
/// (differences of float coordinates are nearly exact in double), not from differences of dot
/// products, whose rounding a hull with short edges would magnify.
///
/// @param x, y, z  the direction in hull axes, of any length; apart, as they pass in registers
/// @param start    < hull.count; where a climb starts
/// The dot product found is the largest up to a few double roundings of |direction|.
/// Cost: hull.count dot products, or the neighbours of the vertices climbed over (at most
/// kMaxClimbSteps, then hull.count more).
[[nodiscard]] Farthest farthest(const Hull& hull, double x, double y, double z,
                                std::uint32_t start) noexcept;

/// Its index.
[[nodiscard]] inline std::uint32_t support(const Hull& hull, Vec3d direction,
                                           std::uint32_t start) noexcept {
  return farthest(hull, direction.x, direction.y, direction.z, start).vertex;
}

/// Position of a vertex in hull coordinates, unscaled.
inline Vec3d position(const Hull& hull, std::uint32_t vertex) noexcept {
  return vec3d(hull.vertices[vertex].position);
}

}  // namespace palpate::convex
