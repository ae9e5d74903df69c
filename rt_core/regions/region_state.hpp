// SPDX-License-Identifier: Apache-2.0
// What is known of a region's distance, and for how long it holds.
#pragma once

#include <cstdint>

#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/near_pairs.hpp"
#include "rt_core/regions/seeds.hpp"

namespace palpate::regions {

/// Rounding of the centres and of the odometers, in units.
inline constexpr double kMotionSlack = 1e-9;

/// Where a region stood when something was proved of it.
struct Stand {
  Vec3d centre{};     ///< in the coordinates of b
  double travel = 0;  ///< PairState::travel
  double turn = 0;    ///< PairState::turn
};

/// What is kept of a region from tick to tick. Lengths in units of the pair.
///
/// The proof: when the region stood `at`, every pair of its triangles and b's was in `near`, or at
/// least `rest` apart. Since then no distance has shrunk by more than the region has moved
/// (moved_since()).
struct RegionState {
  float rest = 0;
  float lower = 0;  ///< the least of `rest` and of the distances of `near`
  Stand at;
  /// Its distance is of the last tick in which the region was active: of a contact exact, else
  /// perhaps a bound from below that is no less than delta.
  Witness witness;
  double active_at = 0;  ///< way_of() in that tick
  float cost = 0;        ///< work units of the last search of all of it; 0: not known
  NearPairs near;
  /// Of each of `near`: its distance when it was last measured, and the way since the proof then.
  float apart[kNearPairs];
  Seeds seeds;  ///< other places of it that are followed (follow.hpp)
};

[[nodiscard]] Stand stand_of(const levels::PairState& pair, std::uint32_t region) noexcept;

/// How far any point of a region has moved against b since it stood there, at most: the
/// displacement of its centre, not the way it took, and its radius times all turns since.
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

/// Proves at the present poses that the pairs which are not in state.near are at least `rest`
/// apart.
void prove(RegionState& state, const levels::PairState& pair, std::uint32_t region,
           float rest) noexcept;

}  // namespace palpate::regions
