// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles of active regions, measured sixteen at a time.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Holds pairs, not places where they are kept: what is done with one that has been measured may
/// move others. While it is not empty, nothing else may use the batch of work.memory.search.
template <class Take>
class PairBatch {
 public:
  /// @param take  called as take(index, pair) for each pair that is measured, in the order in which
  /// they were added, its distance at the present poses
  PairBatch(Work& work, Take take) noexcept : work_(work), take_(take) {}

  /// @param index  of the active region that the pair is of
  void add(std::uint32_t index, const Witness& pair) noexcept {
    SearchScratch& scratch = *work_.memory.search;
    const std::span<const Active> active = work_.active();
    const bool of_others =
        count_ > 0 && active[scratch.batch_of[0]].pair != active[index].pair;  // other bodies
    if (count_ == kBatch || of_others) measure_all();
    scratch.batch_of[count_] = index;
    scratch.batch_a[count_] = pair.a;
    scratch.batch_b[count_] = pair.b;
    ++count_;
  }

  /// Measures what is left. kBatchUnits units, or none.
  void measure_all() noexcept {
    if (count_ == 0) return;
    float distances[kBatch];
    SearchScratch& scratch = *work_.memory.search;
    const PairFrame& frame = work_.frame_of(work_.active()[scratch.batch_of[0]]);
    measure(*work_.memory.kernels, frame, scratch, work_.pace, count_, distances);
    for (std::uint32_t i = 0; i < count_; ++i) {
      take_(scratch.batch_of[i], Witness{scratch.batch_a[i], scratch.batch_b[i], distances[i]});
    }
    count_ = 0;
  }

 private:
  Work& work_;
  Take take_;
  std::uint32_t count_ = 0;
};

}  // namespace palpate::regions
