// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of convex hulls and the poses in which the benchmark asks for their distance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/convex/hull.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::bench {

/// A hull that owns its memory, as large as the unit ball.
struct BenchHull {
  std::vector<image::Vertex> vertices;
  std::vector<std::uint32_t> starts;
  std::vector<std::uint32_t> neighbours;
  std::vector<std::array<std::uint32_t, 3>> faces;  ///< counter-clockwise seen from outside

  [[nodiscard]] convex::Hull scanned() const;  ///< without adjacency
  [[nodiscard]] convex::Hull climbed() const;  ///< with it
  /// As the image holds it: adjacency above image::kAdjacencyAbove vertices.
  [[nodiscard]] convex::Hull baked() const;
};

/// Two hulls, and b's poses in the coordinates of a.
struct Motion {
  BenchHull a;
  BenchHull b;
  std::vector<RelativePose> poses;
};

enum class Coherence : std::uint8_t {
  coherent,    ///< 0.2 degree and 0.1 % of the radius a step
  incoherent,  ///< every pose at random
};

inline constexpr double kLeastGap = 0.01;  ///< between the hulls; their radius is 1
inline constexpr double kLargestGap = 0.2;

/// `pairs` motions of `steps` poses, of hulls with exactly `vertices` vertices: points at random on
/// ellipsoids with half axes 1, 0.6 to 1 and 0.6 to 1. The same on every run.
[[nodiscard]] std::vector<Motion> make_motions(std::uint32_t vertices, Coherence coherence,
                                               std::uint32_t pairs, std::uint32_t steps);

/// How far `distance` can be from the truth: the width of the gap between the hulls along `normal`
/// (unit, from b to a) is measured over all vertices in long double and bounds it from below.
/// @param distance  between points of the hulls, so that it bounds the truth from above
[[nodiscard]] double distance_error(const Motion& motion, const RelativePose& pose, double distance,
                                    Vec3d normal);

}  // namespace palpate::bench
