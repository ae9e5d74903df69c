// SPDX-License-Identifier: Apache-2.0
// Bounds of all regions of a at once, for poses about which nothing is known.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/regions/search.hpp"

namespace palpate::regions {

/// What a sweep knows of a region.
struct Swept {
  float squared = 0;                  ///< lower bound of its distance, squared, in units
  std::uint32_t seed = image::kNone;  ///< the nearest child of b that was met; kNone: none is near
};

/// Descends both trees together down to the regions, so that what is far is told once for many
/// regions; parts of b are divided until they are no larger than twice the region. The bounds hold
/// wherever the budget ends it.
/// @param limit  bounds from here on are not refined
/// @param out    [regions of a]
/// Cost: the budget, or all pairs of boxes nearer than limit down to the size of regions.
void sweep(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
           float limit, std::span<Swept> out) noexcept;

}  // namespace palpate::regions
