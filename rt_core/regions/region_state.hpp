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
  Witness witness;  ///< its distance is of the last tick it was measured in
  float cost = 0;   ///< work units of the last search of all of it; 0: not known
  NearPairs near;
  Seeds seeds;  ///< other places of it that are followed (follow.hpp)
};

[[nodiscard]] Stand stand_of(const levels::PairState& pair, std::uint32_t region) noexcept;

/// How far any point of a region has moved against b since it stood there, at most: the
/// displacement of its centre, not the way it took, and its radius times all turns since.
[[nodiscard]] double moved_since(const Stand& at, const levels::PairState& pair,
                                 std::uint32_t region) noexcept;

/// The same by the odometers alone: the way and not the displacement, and all of the body. Reads
/// nothing but the state, so that far regions cost next to nothing.
[[nodiscard]] inline double way_since(const RegionState& state,
                                      const levels::PairState& pair) noexcept {
  constexpr double kMostReach = 1.51;  // of image::Region::reach, with room for rounding
  return (pair.travel - state.at.travel) + (pair.turn - state.at.turn) * pair.scale_a * kMostReach +
         kMotionSlack;
}

/// Proves at the present poses that the pairs which are not in state.near are at least `rest`
/// apart.
void prove(RegionState& state, const levels::PairState& pair, std::uint32_t region,
           float rest) noexcept;

}  // namespace palpate::regions
