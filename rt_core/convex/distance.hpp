// SPDX-License-Identifier: Apache-2.0
// Distance between two convex hulls, warm-started.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/convex/hull.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::convex {

/// The simplex of the last query of a pair: vertex indices of a and of b. Only an accelerator: any
/// content with indices in range, repeated ones too, gives the same answer up to rounding;
/// count = 0 starts cold.
struct Cache {
  std::uint32_t count = 0;  ///< 0 to 4
  std::uint32_t a[4] = {};
  std::uint32_t b[4] = {};
};

enum class State : std::uint8_t {
  separated,    ///< lower_bound > 0, witnesses valid
  touching,     ///< distance and depth along `normal` are within kTouching, beside needles
                ///< kDistanceAccept, of nothing
  penetrating,  ///< the hulls share interior points; ask penetration()
  gave_up,      ///< met the cap or rounding: [lower_bound, distance] still holds the truth, the
                ///< witnesses are the best so far
};

/// In the coordinates of a, lengths in the unit of the scales.
struct Distance {
  State state = State::separated;
  double distance = 0;  ///< upper bound of the distance: |point_a - point_b|; 0 where penetrating
  double lower_bound =
      0;            ///< proved: a slab of this width, normal to `normal`, parts the hulls; >= 0
  Vec3d point_a{};  ///< witness on a; not set where penetrating
  Vec3d point_b{};  ///< witness on b, in the coordinates of a; not set where penetrating
  Vec3d normal{};   ///< unit, from b to a; zero where penetrating
  /// [count_a] hull vertices whose convex combination point_a is; entries beyond are not set
  std::uint32_t vertices_a[3];
  double weights_a[3];          ///< [count_a] > 0, sum 1
  std::uint32_t vertices_b[3];  ///< [count_b] likewise
  double weights_b[3];          ///< [count_b]
  std::uint32_t count_a = 0;    ///< 1 to 3 distinct vertices; 0 where penetrating
  std::uint32_t count_b = 0;
  std::uint32_t iterations = 0;  ///< support pairs found
};

/// The hulls touch or share points.
[[nodiscard]] inline bool overlaps(const Distance& d) noexcept {
  return d.state == State::penetrating || d.state == State::touching;
}

/// What is enough to know of hulls that are apart. By default the distance itself.
struct Enough {
  /// >= 0: that they are farther apart (lower_bound > above)
  double above = std::numeric_limits<double>::infinity();
  double below = 0;  ///< that they are not (distance <= below); 0: never
};

inline constexpr std::uint32_t kMaxDistanceIterations = 64;

// Relative to the sum of the scales.
inline constexpr double kTouching = 1e-9;      ///< less distance or depth than this is none
inline constexpr double kDistanceGap = 1e-10;  ///< upper less lower bound at which the search ends
inline constexpr double kDistanceAccept = 1e-7;  ///< and which rounding may leave; else gave_up

/// The distance of hulls a and b (Gilbert, Johnson, Keerthi 1988; the simplex is solved as
/// simplex.hpp says), warm from `cache`, which is updated.
///
/// All arithmetic is in double, support searches included (support.hpp): the answer is exact to
/// 1e-7 of the hulls' coordinates, usually to 1e-15; slivers, flat and one-point hulls included.
/// The search ends where upper less lower bound is within kDistanceGap (sum of scales + distance),
/// where the upper bound stops shrinking, or at the cap. Where the origin meets a simplex that does
/// not enclose it, searches with a shifted by kTouching either way, then by 30 times that, tell
/// touching from penetrating.
///
/// @param a, b    scales from 1e-30 to 1e30
/// @param b_in_a  maps scaled coordinates of b to scaled coordinates of a; finite
/// @param enough  may return State::separated early; the witnesses are then only good for a warm
///                start
/// @param guess   of the direction from b to a, 1e-9 long or more, in the coordinates of a:
///                where a search with a cold cache starts; zero: none
/// Never NaN for finite input. Cost: at most 5 * kMaxDistanceIterations + 2 support pairs; one
/// where warm. No memory. Real-time safe.
[[nodiscard]] Distance distance(const Hull& a, const Hull& b, const RelativePose& b_in_a,
                                const Enough& enough, Cache& cache, Vec3d guess = {}) noexcept;

}  // namespace palpate::convex
