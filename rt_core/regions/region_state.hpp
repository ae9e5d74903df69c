// SPDX-License-Identifier: Apache-2.0
// What is known of a region's distance, and for how long it holds.
#pragma once

#include <cstdint>

#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/near_pairs.hpp"

namespace palpate::regions {

/// Rounding of the centres and of the odometers, in units.
inline constexpr double kMotionSlack = 1e-9;

/// Where a region stood when something was proved of it, and the way from there along which the
/// proof holds as well.
struct Stand {
  Vec3d centre{};     ///< in the coordinates of b
  Vec3d course{};     ///< likewise; 0: it holds there only
  double travel = 0;  ///< PairState::travel
  double turn = 0;    ///< PairState::turn
};

/// What is kept of a region from tick to tick, with its RegionPairs. Lengths in units of the pair.
///
/// The proof: while the region is on its course, turned as it was where it stood `at`, every pair
/// of its triangles and b's is in RegionPairs::near, or at least `rest` apart. No distance is less
/// than on the course by more than the region is off it (moved_since()).
struct RegionState {
  float rest = 0;
  float lower = 0;  ///< the least of `rest` and of the distances of the kept pairs
  Stand at;
  double active_at = 0;  ///< way_of() in the last tick in which the region was active
  float ahead = 1;       ///< share of the ticks for which it is given a course (close.cpp)
  /// So many exact searches to come keep nothing, for it would not last.
  std::uint32_t bare_searches = 0;
};

/// Pairs of triangles that are remembered of a region. Apart from its state, of which every near
/// region is asked in every tick: states alone stay in the cache.
struct RegionPairs {
  NearPairs near;  ///< with their least distances on the course, or less
  /// Of each of `near`: its distance when it was last measured, and the way since the proof then.
  float apart[kNearPairs];
};

/// Of a region, in the coordinates of b.
[[nodiscard]] Vec3d centre_of(const levels::PairState& pair, std::uint32_t region) noexcept;

/// How far that moves in a tick, about: the mean of the last ticks.
[[nodiscard]] Vec3d step_of(const levels::PairState& pair, std::uint32_t region) noexcept;

[[nodiscard]] Stand stand_of(const levels::PairState& pair, std::uint32_t region,
                             Vec3d course = {}) noexcept;

/// How far any point of a region is from where it was on the region's course, at most: how far its
/// centre is from the nearest place on that, and its radius times all turns since.
[[nodiscard]] double moved_since(const Stand& at, const levels::PairState& pair,
                                 std::uint32_t region) noexcept;

/// The same by the odometers alone: the way and not the displacement. Unlike displacements, ways
/// add up.
/// @param reach  image::Region::reach, or more than that of any region
[[nodiscard]] inline double way_since(const Stand& at, const levels::PairState& pair,
                                      double reach) noexcept {
  return (pair.travel - at.travel) + (pair.turn - at.turn) * pair.scale_a * reach + kMotionSlack;
}

/// How far any point of a region has gone against b in all ticks, at most.
[[nodiscard]] inline double way_of(const levels::PairState& pair, std::uint32_t region) noexcept {
  return pair.travel +
         pair.turn * pair.scale_a * static_cast<double>(pair.image_a->regions[region].reach);
}

/// The same of any point of a.
[[nodiscard]] inline double most_way_of(const levels::PairState& pair) noexcept {
  constexpr double kMostReach = 1.51;  // of image::Region::reach, with room for rounding
  return pair.travel + pair.turn * pair.scale_a * kMostReach;
}

/// Proves that from the present poses on, along a course, the pairs which are not in `kept` are at
/// least `rest` apart.
void prove(RegionState& state, RegionPairs& kept, const levels::PairState& pair,
           std::uint32_t region, float rest, Vec3d course = {}) noexcept;

}  // namespace palpate::regions
