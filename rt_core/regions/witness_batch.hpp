// SPDX-License-Identifier: Apache-2.0
// Witnesses of active regions at the present poses, sixteen at a time, and which way they lie.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// While it is not empty, nothing else may use the batch of work.memory.search.
class WitnessBatch {
 public:
  explicit WitnessBatch(Work& work) noexcept : work_(work) {}

  /// @param index  of an active region, whose witness is known
  void add(std::uint32_t index) noexcept {
    const std::span<const Active> active = work_.active();
    const bool of_others = count_ > 0 && active[of_[0]].pair != active[index].pair;
    if (count_ == kBatch || of_others) measure_all();
    const Witness& witness = work_.witness_of(active[index]);
    SearchScratch& scratch = *work_.memory.search;
    scratch.batch_a[count_] = witness.a;
    scratch.batch_b[count_] = witness.b;
    of_[count_++] = index;
  }

  /// Measures what is left. kBatchUnits units, or none.
  void measure_all() noexcept {
    if (count_ == 0) return;
    const PairFrame& frame = work_.frame_of(work_.active()[of_[0]]);
    float distances[kBatch];
    WayLanes ways;
    measure_ways(*work_.memory.kernels, frame, *work_.memory.search, work_.pace, count_, distances,
                 ways);
    for (std::uint32_t i = 0; i < count_; ++i) {
      Active& item = work_.active()[of_[i]];
      Witness& witness = work_.witness_of(item);
      witness.distance = distances[i];
      item.way = way_of(ways, i, witness);
    }
    count_ = 0;
  }

 private:
  Work& work_;
  std::uint32_t of_[kBatch];
  std::uint32_t count_ = 0;
};

}  // namespace palpate::regions
