// SPDX-License-Identifier: Apache-2.0
// Witnesses of regions that cannot all be searched, kept near without searches.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

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
