// SPDX-License-Identifier: Apache-2.0
// The distance of two triangles in double: what the kernels in float are compared with.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "rt_core/convex/simplex.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::test {

struct TriangleDistance {
  double distance = 0;  ///< |point_a - point_b|; 0 where they cross
  Vec3d point_a{};      ///< on a
  Vec3d point_b{};      ///< on b
};

namespace triangles {

using Corners = Vec3d[3];

/// The nearest pair of points so far.
struct Closest {
  double squared = std::numeric_limits<double>::infinity();
  Vec3d first{};
  Vec3d second{};
};

constexpr std::uint32_t next(std::uint32_t i) noexcept { return i == 2 ? 0 : i + 1; }

inline double clamp(double v) noexcept { return v < 0 ? 0 : (v > 1 ? 1 : v); }

inline void keep_nearer(Closest& best, Vec3d first, Vec3d second) noexcept {
  const double squared = squared_norm(first - second);
  if (squared < best.squared) best = {squared, first, second};
}

/// A corner of the second triangle against the first.
inline void corner_and_face(const Corners& face, Vec3d corner, Closest& best) noexcept {
  const Vec3d local[3] = {face[0] - corner, face[1] - corner, face[2] - corner};
  const convex::Nearest n = convex::nearest_on_triangle(local, 0, 1, 2);
  Vec3d p{};
  for (std::uint32_t i = 0; i < n.count; ++i) p += n.weight[i] * face[n.index[i]];
  keep_nearer(best, p, corner);
}

/// Two edges, where their common perpendicular has a direction; parallel ones are as near at a
/// corner.
inline void edge_and_edge(Vec3d p0, Vec3d p1, Vec3d q0, Vec3d q1, Closest& best) noexcept {
  const Vec3d u = p1 - p0;
  const Vec3d v = q1 - q0;
  const Vec3d across = cross(u, v);
  const double across2 = squared_norm(across);
  const double v2 = squared_norm(v);
  if (!(across2 > convex::kMinSine * convex::kMinSine * squared_norm(u) * v2)) return;
  const double s = clamp(dot(cross(q0 - p0, v), across) / across2);
  const Vec3d p = p0 + s * u;
  const double t = clamp(dot(p - q0, v) / v2);
  keep_nearer(best, p, q0 + t * v);
}

/// The point where an edge passes through a face. Passing through its border is left to
/// edge_and_edge, touching it to corner_and_face.
inline void edge_through_face(const Corners& face, Vec3d p, Vec3d q, Closest& best) noexcept {
  const Vec3d normal = cross(face[1] - face[0], face[2] - face[0]);
  const double above = dot(normal, p - face[0]);
  const double below = dot(normal, q - face[0]);
  if (!(above * below < 0)) return;
  const Vec3d x = p + (above / (above - below)) * (q - p);
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (!(dot(normal, cross(face[next(i)] - face[i], x - face[i])) >= 0)) return;
  }
  best = {0, x, x};
}

inline void swap_sides(Closest& c) noexcept { c = {c.squared, c.second, c.first}; }

}  // namespace triangles

/// Slivers, segments and points are triangles too; where the triangles cross, the witnesses are a
/// common point. The least of the ways a distance can be met: a corner and the other triangle, two
/// edges, an edge that pierces the other triangle; never too small, and too large by some 1e-15 of
/// the largest coordinate difference, up to 1e-7 of it where a sine is near convex::kMinSine.
inline TriangleDistance triangle_distance(const Vec3d (&a)[3], const Vec3d (&b)[3]) noexcept {
  using namespace triangles;
  Closest best;
  for (std::uint32_t i = 0; i < 3; ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      edge_and_edge(a[i], a[next(i)], b[k], b[next(k)], best);
    }
    corner_and_face(a, b[i], best);
    edge_through_face(a, b[i], b[next(i)], best);
  }
  swap_sides(best);
  for (std::uint32_t i = 0; i < 3; ++i) {
    corner_and_face(b, a[i], best);
    edge_through_face(b, a[i], a[next(i)], best);
  }
  swap_sides(best);
  return {std::sqrt(best.squared), best.first, best.second};
}

}  // namespace palpate::test
