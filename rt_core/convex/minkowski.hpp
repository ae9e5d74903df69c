// SPDX-License-Identifier: Apache-2.0
// The Minkowski difference a - b of two hulls, which contains the origin where the hulls meet.
// Coordinates of a, in the unit of the scales.
#pragma once

#include <cstdint>

#include "rt_core/convex/support.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::convex {

/// Two hulls and how they lie; borrows all three.
struct HullPair {
  const Hull& a;
  const Hull& b;
  const RelativePose& b_in_a;
};

/// A vertex of a minus a vertex of b.
struct DifferencePoint {
  Vec3d point{};
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

inline Vec3d vertex_of_a(const HullPair& pair, std::uint32_t i) noexcept {
  return pair.a.scale * position(pair.a, i);
}

/// A vertex of b, in the coordinates of a.
inline Vec3d vertex_of_b(const HullPair& pair, std::uint32_t i) noexcept {
  return pair.b_in_a.rotation * (pair.b.scale * position(pair.b, i)) + pair.b_in_a.translation;
}

inline DifferencePoint difference(const HullPair& pair, std::uint32_t a, std::uint32_t b) noexcept {
  return {vertex_of_a(pair, a) - vertex_of_b(pair, b), a, b};
}

/// A vertex of a and one of b.
struct VertexPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// A vertex of a - b, and its dot product with a direction.
struct FarthestPair {
  VertexPair vertices;
  double dot = 0;
};

/// The vertex of a - b farthest in `direction` (coordinates of a, any length); climbs from `start`.
inline FarthestPair farthest(const HullPair& pair, Vec3d direction, VertexPair start) noexcept {
  const Mat3d& r = pair.b_in_a.rotation;
  const Vec3d in_b = direction.x * r.row0 + direction.y * r.row1 + direction.z * r.row2;
  const Farthest a = farthest(pair.a, direction.x, direction.y, direction.z, start.a);
  const Farthest b = farthest(pair.b, -in_b.x, -in_b.y, -in_b.z, start.b);
  const double along = dot(direction, pair.b_in_a.translation);
  return {{a.vertex, b.vertex}, pair.a.scale * a.dot + pair.b.scale * b.dot - along};
}

/// The same with its point.
inline DifferencePoint support(const HullPair& pair, Vec3d direction,
                               const DifferencePoint& start) noexcept {
  const VertexPair v = farthest(pair, direction, {start.a, start.b}).vertices;
  return difference(pair, v.a, v.b);
}

/// Largest extent that a coordinate of either hull about its own origin can have.
inline double extent(const HullPair& pair) noexcept { return pair.a.scale + pair.b.scale; }

/// No dot product of a unit direction with a point of a - b is computed farther off than this, be
/// it as in farthest() or from the point.
inline double rounding(const HullPair& pair) noexcept {
  // A transformed point or direction and its dot: at most 14 operations, and what rises() passes
  // over in each hull; on coordinates up to
  // image::kMaxNorm.
  constexpr double kRoundings = 64 * 1.2e-16;
  const Vec3d t = pair.b_in_a.translation;
  return kRoundings *
         (extent(pair) + __builtin_fabs(t.x) + __builtin_fabs(t.y) + __builtin_fabs(t.z));
}

}  // namespace palpate::convex
