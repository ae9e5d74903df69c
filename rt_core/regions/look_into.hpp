// SPDX-License-Identifier: Apache-2.0
// Looks, and the pairs that they find measured.
#pragma once

#include "rt_core/regions/look.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Looks that go on where the last ones of the region ended.
/// @param item   whose frame can_look()
/// @param count  so many more that `out` has room for them
inline void look_on(Work& work, const Active& item, std::uint32_t count, Looks& out) noexcept {
  std::uint32_t& so_far = work.kept_of(item).seeds.dives;
  look_over(work.frame_of(item), item.region, so_far, count, out);
  so_far += count;
}

/// A region's next looks, all at once; a unit for kLooksPerUnit of them.
/// @param index  of the active region, whose frame can_look()
/// @param count  at most kMostLooks
/// @param batch  a PairBatch
void look_into(Work& work, std::uint32_t index, std::uint32_t count, auto& batch) noexcept {
  const Active& item = work.active()[index];
  Looks looks;
  look_on(work, item, count, looks);
  look_from(*work.memory.kernels, work.frame_of(item), looks);
  work.pace.charge(count / kLooksPerUnit);
  for (std::uint32_t k = 0; k < count; ++k) batch.add(index, looks.pair(k));
}

/// Looks and the pairs that they find measured, at most.
inline constexpr std::uint64_t kUnitsOfLooks = kMostLooks / kLooksPerUnit + kBatchUnits;

/// Of what looks find. Cost: kUnitsOfLooks.
/// @param looks  before any step; at least one
inline Witness nearest_of(Work& work, const PairFrame& frame, Looks& looks) noexcept {
  SearchScratch& scratch = *work.memory.search;
  look_from(*work.memory.kernels, frame, looks);
  work.pace.charge(looks.count / kLooksPerUnit);
  for (std::uint32_t i = 0; i < looks.count; ++i) {
    scratch.batch_a[i] = looks.a[i];
    scratch.batch_b[i] = looks.b[i];
  }
  float distances[kBatch];
  measure(*work.memory.kernels, frame, scratch, work.pace, looks.count, distances);
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < looks.count; ++i) {
    if (distances[i] < distances[nearest]) nearest = i;
  }
  return {looks.a[nearest], looks.b[nearest], distances[nearest]};
}

}  // namespace palpate::regions
