// SPDX-License-Identifier: Apache-2.0
// Looks, and the pairs that they find measured.
#pragma once

#include "rt_core/regions/look.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Looks that go on where the last ones of the region ended.
/// @param item   whose frame can_look()
/// @param count  at most kMostLooks
inline void look_on(const Work& work, const Active& item, std::uint32_t count,
                    Looks& out) noexcept {
  look_over(work.frame_of(item), item.region, work.kept_of(item).seeds.dives, count, out);
}

/// After their steps; a unit for kLooksPerUnit of them.
/// @param batch  a PairBatch
void add_looks(Work& work, std::uint32_t index, const Looks& looks, auto& batch) noexcept {
  work.pace.charge(looks.count / kLooksPerUnit);
  for (std::uint32_t k = 0; k < looks.count; ++k) batch.add(index, looks.pairs[k]);
}

/// A region's next looks, all at once.
/// @param index  of the active region, whose frame can_look()
void look_into(Work& work, std::uint32_t index, std::uint32_t count, auto& batch) noexcept {
  const Active& item = work.active()[index];
  Looks looks;
  look_on(work, item, count, looks);
  look_from(work.frame_of(item), looks);
  work.kept_of(item).seeds.dives += count;
  add_looks(work, index, looks, batch);
}

/// Looks and the pairs that they find measured, at most.
inline constexpr std::uint64_t kUnitsOfLooks = kMostLooks / kLooksPerUnit + kBatchUnits;

/// Of what looks find. Cost: kUnitsOfLooks.
/// @param looks  before any step; at least one
inline Witness nearest_of(Work& work, const PairFrame& frame, Looks& looks) noexcept {
  SearchScratch& scratch = *work.memory.search;
  look_from(frame, looks);
  work.pace.charge(looks.count / kLooksPerUnit);
  for (std::uint32_t i = 0; i < looks.count; ++i) {
    scratch.batch_a[i] = looks.pairs[i].a;
    scratch.batch_b[i] = looks.pairs[i].b;
  }
  static_assert(kMostLooks == kBatch);
  float distances[kBatch];
  measure(*work.memory.kernels, frame, scratch, work.pace, looks.count, distances);
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < looks.count; ++i) {
    if (distances[i] < distances[nearest]) nearest = i;
  }
  return {looks.pairs[nearest].a, looks.pairs[nearest].b, distances[nearest]};
}

}  // namespace palpate::regions
