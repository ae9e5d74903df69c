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

/// The vertex of a - b farthest in `direction` (coordinates of a, any length); climbs from `start`.
inline DifferencePoint support(const HullPair& pair, Vec3d direction,
                               const DifferencePoint& start) noexcept {
  const Mat3d& r = pair.b_in_a.rotation;
  const Vec3d in_b = direction.x * r.row0 + direction.y * r.row1 + direction.z * r.row2;
  return difference(pair, support(pair.a, direction, start.a), support(pair.b, -in_b, start.b));
}

/// Largest extent that a coordinate of either hull about its own origin can have.
inline double extent(const HullPair& pair) noexcept { return pair.a.scale + pair.b.scale; }

/// No dot product of a unit direction with a point of a - b is computed farther off than this.
inline double rounding(const HullPair& pair) noexcept {
  // A transformed point and its dot: 12 operations, on coordinates up to image::kMaxNorm.
  constexpr double kRoundings = 24 * 1.2e-16;
  const Vec3d t = pair.b_in_a.translation;
  const auto absolute = [](double v) { return v < 0 ? -v : v; };
  return kRoundings * (extent(pair) + absolute(t.x) + absolute(t.y) + absolute(t.z));
}

}  // namespace palpate::convex
