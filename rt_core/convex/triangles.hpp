// SPDX-License-Identifier: Apache-2.0
// Distance between two triangles.
#pragma once

#include "rt_core/geometry/vec3.hpp"

namespace palpate::convex {

struct TriangleDistance {
  double distance = 0;  ///< |point_a - point_b|; 0 where they cross
  Vec3d point_a{};      ///< on a
  Vec3d point_b{};      ///< on b
};

/// The distance of two triangles given by their corners in one frame, in any unit; slivers,
/// segments and points are triangles too. Where they cross, the witnesses are a common point.
///
/// The least of the ways a distance can be met: a corner and the other triangle, two edges, an edge
/// that pierces the other triangle. Every candidate is a pair of points of the triangles, so that
/// the result is never too small. Error, of result and witnesses: some 1e-15 of the largest
/// coordinate difference; up to 1e-7 of it where a triangle's or two edges' sine is near kMinSine.
/// Cost: 6 corners, 9 pairs of edges, 6 piercings; no loop depends on the data. Real-time safe.
[[nodiscard]] TriangleDistance triangle_distance(const Vec3d (&a)[3], const Vec3d (&b)[3]) noexcept;

}  // namespace palpate::convex
