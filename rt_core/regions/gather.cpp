// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/gather.hpp"

#include <limits>

#include "rt_core/regions/kept.hpp"
#include "rt_core/regions/motion.hpp"
#include "rt_core/regions/scout.hpp"
#include "rt_core/regions/survey.hpp"
#include "rt_core/regions/witness_batch.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

/// A move by more than this (in units), or by this many delta where that is more, starts anew.
constexpr double kJump = 0.05;
constexpr double kJumpDelta = 2;
/// Under a budget a sweep may take whichever is most: this share of a tick, so many units, or so
/// many for each region; and no more than half of what is left. It tells what is far, many regions
/// at a time; of surfaces that are near all over, little, and that costs most.
constexpr double kMostSwept = 0.04;
constexpr double kLeastSwept = 128;
constexpr double kSweptPerRegion = 0.25;
/// Units for a first contact. Of smooth bodies nearly all are found with 50; between parts of long
/// triangles, of which many are nearly near enough, with these.
constexpr double kMostScouted = 600;
/// Under a budget a tick begins anew, with what it knows, where so many regions are felt still of
/// bodies that have moved on, for of fewer, witnesses that climb tell more, and where searches of
/// all that may be near take so many ticks. What is known of many is right on some sides and out of
/// date on others, and the force, in which those weigh against each other, is off by more than
/// where a few from everywhere are looked up.
constexpr std::uint32_t kManyFelt = 16;
constexpr double kMostTicks = 2;

void limit_sweep(Work& work, std::size_t regions) noexcept {
  const double units = work.units_of_tick();
  if (units == std::numeric_limits<double>::infinity()) return;
  double most = kSweptPerRegion * static_cast<double>(regions);
  most = most > kLeastSwept ? most : kLeastSwept;
  most = most > kMostSwept * units ? most : kMostSwept * units;
  const double half = 0.5 * work.units_left();
  most = most < half ? most : half;
  work.pace.limit(static_cast<std::uint64_t>(most));
}

/// @return whether all regions of the pair have been proved anew
bool sweep_if_lost(Work& work, std::uint32_t index) noexcept {
  QueryMemory& memory = work.memory;
  PairState& pair = memory.pairs[index];
  const double far = kJumpDelta * pair.delta > kJump ? kJumpDelta * pair.delta : kJump;
  if (!pair.fresh && last_motion(pair) <= far) return false;
  pair.fresh = false;
  leave_no_trail(pair);
  const std::size_t regions = pair.image_a->regions.size();
  work.swept = true;
  work.room = Work::kLeastRoom;  // there is much to search, and how the bodies move is not known
  memory.containment[index] = {};
  memory.pursuit.surveyed = 1;  // what a survey had left of another place is none of this one
  for (std::uint32_t i = 0; i < regions; ++i) {
    memory.scouted[memory.first_state[index] + i] = 0;
    memory.lasting[memory.first_state[index] + i] = 0;
  }
  // However small the budget is for the rest of the tick, it knows where the bodies touch.
  if (work.demand.limited) scout(work, index, kMostScouted);
  const std::span<float> swept = memory.swept.first(regions);
  limit_sweep(work, swept.size());
  sweep(*memory.kernels, memory.frames[index], *memory.search, work.pace,
        static_cast<float>(pair.delta + margin_of(pair)), swept);
  work.pace.no_limit();
  for (std::uint32_t i = 0; i < swept.size(); ++i) {
    const std::uint32_t at = memory.first_state[index] + i;
    RegionPairs& kept = memory.kept[at];
    kept.near.count = 0;
    kept.seeds.count = 0;
    const float by_sweep = sqrt_of(swept[i]) - kRounding;
    const float by_scout = float_below(memory.lasting[at] - most_way_of(pair));
    prove(memory.states[at], kept, pair, i, by_sweep > by_scout ? by_sweep : by_scout);
  }
  return true;
}

/// The regions of a pair that may be nearer than delta.
/// @param swept  in this tick: no region has moved since its proof
void gather_regions(Work& work, std::uint32_t index, bool swept) noexcept {
  QueryMemory& memory = work.memory;
  const PairState& pair = memory.pairs[index];
  const std::uint32_t first = memory.first_state[index];
  const auto regions = pair.image_a->regions;
  const double far = pair.delta + pair.deviation;
  const double way = most_way_of(pair);
  for (std::uint32_t i = 0; i < regions.size(); ++i) {
    double& lasting = memory.lasting[first + i];
    if (!swept && lasting - way - kMotionSlack >= far) continue;
    const RegionState& state = memory.states[first + i];
    const double moved_by = swept ? kMotionSlack : moved_since(state.at, pair, i);
    const double lower = static_cast<double>(state.lower) - moved_by;
    // Odometers add up where regions go to and fro: from here on, of the way that is left.
    lasting = lower + way;
    if (lower >= pair.delta) {
      if (lower < far) work.result.open_m += (far - lower) * pair.unit_m;
      continue;
    }
    if (lower <= 0) memory.containment[index].unseen = true;
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
    Active& item = work.active()[i];
    // What lies beside what is certainly not felt is not looked at either.
    item.climbed = is_still_far(work, item);
    const Witness& witness = work.witness_of(item);
    if (item.climbed || !witness.known()) continue;
    if (static_cast<double>(witness.distance) <= last_motion(work.pair_of(item))) {
      work.memory.containment[item.pair].doubtful = true;
    }
    batch.add(i);
  }
  batch.measure_all();
}

bool feels_any(const Work& work) noexcept {
  for (const Active& item : work.active()) {
    if (work.is_contact(item)) return true;
  }
  return false;
}

/// What a tick does for is known once a search has been completed.
bool does_for_all(const Work& work) noexcept {
  const Pursuit& pursuit = work.memory.pursuit;
  const double units = work.count * pursuit.search_units;
  return pursuit.searches > 0 && units < kMostTicks * work.units_of_tick();
}

bool is_outdated(const Work& work) noexcept {
  if (!work.demand.limited || !can_survey(work)) return false;
  const bool lagged = work.memory.pursuit.lagged;
  std::uint32_t felt = 0;
  for (const Active& item : work.active()) {
    felt += work.is_felt(item) && has_moved_on(work.pair_of(item), lagged) ? 1u : 0u;
  }
  return felt >= kManyFelt && !does_for_all(work);
}

}  // namespace

void gather(Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    work.memory.frames[i] = frame_of(work.memory.pairs[i]);
    gather_regions(work, i, sweep_if_lost(work, i));
  }
  measure_witnesses(work);
  measure_kept(work);
  thin_out(work);
  work.touching = feels_any(work);
  work.anew = work.swept || is_outdated(work);
  work.weigh_all();
  work.widen_all();
}

}  // namespace palpate::regions
