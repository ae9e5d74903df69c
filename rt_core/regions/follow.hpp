// SPDX-License-Identifier: Apache-2.0
// Witnesses of regions that cannot all be searched, kept near without searches.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// A first witness for regions that nothing is known of: the nearest of four to kMostLooks
/// (look.hpp), as many as the units do for. One region comes after the other, and neighbours lie
/// apart, so that what ends early has seen some of everywhere. Where images cannot be looked up in,
/// nothing.
/// @param units       work units to be used, at most, to a batch
/// @param least_felt  nothing more is looked up where a smaller part of the first regions is felt
void look_first(Work& work, double units, double least_felt) noexcept;

/// Moves witnesses of the active regions to nearer pairs, where one is known already and its
/// region is open. In this order, each with a share of the units, and what ends early begins at
/// another region in the next tick: seeds that may be nearer than the witness are measured; every
/// sixth witness and every second region's next seed go on to nearer neighbours; and new seeds are
/// sought in parts of the regions in turn, by looks (look.hpp) or, in images without a grid, dives.
///
/// Proves nothing and leaves all bounds alone; witnesses are at the present poses as before. The
/// widths of the regions are the caller's to renew.
/// @param units  work units to be used, about
void follow(Work& work, double units) noexcept;

}  // namespace palpate::regions
