// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles that lie apart: from one of them the nearest of a region comes next.
#pragma once

#include <cstdint>

#include "rt_core/image/view.hpp"
#include "rt_core/regions/near_pairs.hpp"

namespace palpate::regions {

/// How many are kept of a region. Where two dimpled surfaces fit each other, a region of eight
/// contact tolerances has some fourteen places from which every step to a neighbour leads away.
inline constexpr std::uint32_t kSeeds = 16;

/// The nearest pairs met in different places of a region.
///
/// Surfaces that fit each other are nearly as near in many places. Which is the nearest changes
/// with the direction of the motion, to one that lay far off and was never the nearest before; but
/// each place moves little from tick to tick. Nothing is proved with seeds: they are measured
/// before they count.
struct Seeds {
  std::uint32_t count = 0;
  std::uint32_t dives = 0;  ///< so far (dive())
  double travel_at = 0;     ///< PairState::travel ...
  double turn_at = 0;       ///< ... and turn to which the distances have been lowered
  // Side by side, so that a pair is held against all of them at once.
  std::uint32_t a[kSeeds] = {};
  std::uint32_t b[kSeeds] = {};
  float distance[kSeeds] = {};   ///< when it was measured, less the motion since
  float corner[3][kSeeds] = {};  ///< x y z of the first one of the triangle of a, in its image

  /// @param index  below count
  [[nodiscard]] Witness at(std::uint32_t index) const noexcept {
    return {a[index], b[index], distance[index]};
  }
};

/// Keeps a pair: instead of the seed in the same place where it is nearer than that, else where
/// there is room, else instead of the farthest where it is nearer. The same place: a common
/// triangle, or first corners closer together than an eighth of the region's radius. O(kSeeds)
void note_seed(const ImageView& a, const Witness& pair, Seeds& seeds) noexcept;

/// Tells how far apart the pair of a seed is now.
/// @return false where the pair is not one of the seeds. O(kSeeds)
bool measure_seed(const Witness& pair, Seeds& seeds) noexcept;

/// Takes a seed to another pair.
/// @param index  below seeds.count
void move_seed(const ImageView& a, std::uint32_t index, const Witness& to, Seeds& seeds) noexcept;

}  // namespace palpate::regions
