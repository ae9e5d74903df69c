// SPDX-License-Identifier: Apache-2.0
// A region's next looks, into a batch of pairs to be measured.
#pragma once

#include "rt_core/regions/look.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Where the last ones of the region ended; a unit for kLooksPerUnit of them.
/// @param index  of the active region, whose frame can_look()
/// @param count  at most kMostLooks
/// @param batch  a PairBatch
void look_into(Work& work, std::uint32_t index, std::uint32_t count, auto& batch) noexcept {
  const Active& item = work.active()[index];
  Seeds& seeds = work.kept_of(item).seeds;
  Witness found[kMostLooks];
  look(work.frame_of(item), item.region, seeds.dives, count, found);
  seeds.dives += count;
  work.pace.charge(count / kLooksPerUnit);
  for (std::uint32_t k = 0; k < count; ++k) batch.add(index, found[k]);
}

}  // namespace palpate::regions
