// SPDX-License-Identifier: Apache-2.0
// Distance between two convex hulls, warm-started.
#pragma once

#include <cstdint>

#include "rt_core/convex/hull.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::convex {

/// The simplex of the last query of a pair: vertex indices of a and of b. Only an accelerator: any content with indices in
/// range gives the same answer up to rounding; count = 0 starts cold.
struct Cache {
  std::uint32_t count = 0;  ///< 0 to 4
  std::uint32_t a[4] = {};
  std::uint32_t b[4] = {};
};

enum class State : std::uint8_t {
  separated,    ///< distance > 0, witnesses valid
  touching,     ///< distance is zero within rounding; normal is the best known one
  penetrating,  ///< the hulls share interior points; ask penetration()
  gave_up,      ///< iteration cap: [lower_bound, distance] still holds the truth, witnesses are the best so far
};

/// In the coordinates of a, lengths in the same unit as the scales of the hulls.
struct Distance {
  State state = State::separated;
  double distance = 0;      ///< upper bound of the distance, met by the witnesses; 0 where penetrating
  double lower_bound = 0;   ///< proved lower bound; equals distance up to rounding where converged
  Vec3d point_a{};          ///< witness on a
  Vec3d point_b{};          ///< witness on b, in the coordinates of a
  Vec3d normal{};           ///< unit, from b to a
  std::uint32_t vertices_a[3] = {};  ///< hull vertices whose convex combination point_a is
  double weights_a[3] = {};
  std::uint32_t vertices_b[3] = {};
  double weights_b[3] = {};
  std::uint32_t count_a = 0;  ///< 1 to 3 distinct vertices
  std::uint32_t count_b = 0;
  std::uint32_t iterations = 0;
};

inline constexpr std::uint32_t kMaxDistanceIterations = 64;

/// The distance of hulls a and b (Gilbert, Johnson, Keerthi 1988; signed volumes after Montanari et al. 2017 or equal), warm
/// from `cache`, which is updated.
///
/// Support points are found in float (brute force up to image::kAdjacencyAbove vertices, else hill climbing over the
/// adjacency, ties to the lower index); the simplex is solved in double, so that the answer is exact to about 1e-7 of the
/// hulls' coordinates, slivers, flat and one-point hulls included. The iteration ends where the gap between upper and lower
/// bound is below 1e-9 + 1e-7 * distance, where it stops shrinking, or at the cap.
///
/// @param b_in_a      maps scaled coordinates of b to scaled coordinates of a
/// @param stop_above  may return State::separated early once lower_bound > stop_above (the witnesses are then only good
///                    for a warm start); infinity for the exact distance
/// Cost: at most kMaxDistanceIterations support pairs; about one where warm. No memory. Real-time safe.
[[nodiscard]] Distance distance(const Hull& a, const Hull& b, const RelativePose& b_in_a, double stop_above, Cache& cache) noexcept;

/// Starts a cold cache from a guess of the separating direction (from b to a, coordinates of a): the two support points.
void seed(const Hull& a, const Hull& b, const RelativePose& b_in_a, Vec3d direction, Cache& cache) noexcept;

}  // namespace palpate::convex
