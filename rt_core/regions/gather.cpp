// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/motion.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

/// A move by more than this (in units), or by this many delta where that is more, starts anew.
constexpr double kJump = 0.05;
constexpr double kJumpDelta = 2;

/// Witnesses of active regions at the present poses, sixteen at a time, and which way they lie.
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

/// @return whether all regions of the pair have been proved anew
bool sweep_if_lost(Work& work, std::uint32_t index) noexcept {
  MinimaMemory& memory = work.memory;
  PairState& pair = memory.pairs[index];
  const double far = kJumpDelta * pair.delta > kJump ? kJumpDelta * pair.delta : kJump;
  if (!pair.fresh && last_motion(pair) <= far) return false;
  pair.fresh = false;
  leave_no_trail(pair);
  work.swept = true;
  const std::span<float> swept = memory.swept.first(pair.image_a->regions.size());
  sweep(*memory.kernels, memory.frames[index], *memory.search, work.pace,
        static_cast<float>(pair.delta + margin_of(pair)), swept);
  for (std::uint32_t i = 0; i < swept.size(); ++i) {
    const std::uint32_t at = memory.first_state[index] + i;
    RegionPairs& kept = memory.kept[at];
    kept.near.count = 0;
    memory.lasting[at] = 0;
    prove(memory.states[at], kept, pair, i, sqrt_of(swept[i]) - kRounding);
  }
  return true;
}

/// The regions of a pair that may be nearer than delta.
/// @param swept  in this tick: no region has moved since its proof
void gather_regions(Work& work, std::uint32_t index, bool swept) noexcept {
  MinimaMemory& memory = work.memory;
  const PairState& pair = memory.pairs[index];
  const std::uint32_t first = memory.first_state[index];
  const auto regions = pair.image_a->regions;
  const double way = most_way_of(pair);
  for (std::uint32_t i = 0; i < regions.size(); ++i) {
    double& lasting = memory.lasting[first + i];
    if (!swept && lasting - way - kMotionSlack >= pair.delta) continue;
    const RegionState& state = memory.states[first + i];
    const double moved_by = swept ? kMotionSlack : moved_since(state.at, pair, i);
    const double lower = static_cast<double>(state.lower) - moved_by;
    // Odometers add up where regions go to and fro: from here on, of the way that is left.
    lasting = lower + way;
    if (lower >= pair.delta) continue;
    memory.active[work.count++] = {.rest = float_below(static_cast<double>(state.rest) - moved_by),
                                   .moved = static_cast<float>(moved_by),
                                   .way = {},
                                   .state = first + i,
                                   .region = i,
                                   .pair = index};
  }
}

/// A witness that was not felt, and cannot be after the way since, need not be measured: from then
/// on its distance is a bound from below.
bool is_still_far(const Work& work, const Active& item) noexcept {
  RegionState& state = work.state_of(item);
  Witness& witness = work.witness_of(item);
  const PairState& pair = work.pair_of(item);
  const double way = way_of(pair, item.region);
  const double since = way - state.active_at + kMotionSlack;
  state.active_at = way;
  const float lower = float_below(static_cast<double>(witness.distance) - since);
  if (!witness.known() || lower < work.delta_of(item) + kClosed) return false;
  witness.distance = lower;
  return true;
}

void measure_witnesses(Work& work) noexcept {
  WitnessBatch batch(work);
  for (std::uint32_t i = 0; i < work.count; ++i) {
    const Active& item = work.active()[i];
    if (!is_still_far(work, item) && work.witness_of(item).known()) batch.add(i);
  }
  batch.measure_all();
}

}  // namespace

void gather(Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    work.memory.frames[i] = frame_of(work.memory.pairs[i]);
    gather_regions(work, i, sweep_if_lost(work, i));
  }
  measure_witnesses(work);
  measure_kept(work);
  for (Active& item : work.active()) work.widen(item);
}

}  // namespace palpate::regions
