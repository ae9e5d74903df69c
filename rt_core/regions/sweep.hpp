// SPDX-License-Identifier: Apache-2.0
// Bounds of all regions of a at once, for poses about which nothing is known.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/regions/search.hpp"

namespace palpate::regions {

/// Descends both trees together down to the regions, so that what is far is told once for many
/// regions; parts of b are divided until they are no larger than four times the region, and passed
/// over where all regions that they might be near to have found as near a part. The bounds hold
/// wherever the budget ends it.
/// @param limit        bounds from here on are not refined
/// @param out_squared  [regions of a] bounds of their distances from below, squared, in units
/// Cost: the budget, or all pairs of boxes nearer than limit down to the size of regions.
void sweep(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
           float limit, std::span<float> out_squared) noexcept;

}  // namespace palpate::regions
