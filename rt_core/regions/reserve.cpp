// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/reserve.hpp"

#include "rt_core/base/queue.hpp"
#include "rt_core/regions/close.hpp"
#include "rt_core/regions/containment.hpp"
#include "rt_core/regions/scout.hpp"

namespace palpate::regions {
namespace {

/// Units for a first contact where looks find one: a budget's scouts have 200 to 600, which do for
/// nearly all (narrow.cpp, gather.cpp).
constexpr double kMostScouted = 1000;

bool may_touch_unfelt(const Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    if (work.may_touch_unfelt(i)) return true;
  }
  return false;
}

/// Of a region: what a tick before has begun may have been for a wider interval.
constexpr int kSearches = 2;

/// The nearest first.
void search_for_any_of(Work& work, std::uint32_t pair) noexcept {
  MinQueue<std::uint32_t, NearerWitness> open(work.memory.queue, NearerWitness{work});
  for (std::uint32_t i = 0; i < work.count; ++i) {
    const Active& item = work.active()[i];
    if (item.pair == pair && item.width > kClosed) open.push(i);
  }
  bool found = false;
  while (!found && !open.empty() && work.pace.go_on()) {
    Active& item = work.active()[open.top()];
    open.pop();
    for (int k = 0; k < kSearches && !found && item.width > kClosed; ++k) {
      search_for_any(work, item);
      found = work.is_contact(item);
    }
  }
}

}  // namespace

void decide_on_reserve(Work& work) noexcept {
  if (!work.demand.limited || !(may_touch_unfelt(work) || may_be_inside(work))) return;
  QueryResult& result = work.result;
  result.truncated_by_units = work.truncated && work.pace.units_ended();
  result.truncated_by_time = work.truncated && work.pace.time_ended();
  if (!work.meter.draw_on_reserve()) return;
  result.on_reserve = true;
  work.pace.resume();
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    if (!work.may_touch_unfelt(i)) continue;
    scout(work, i, kMostScouted);
    if (work.may_touch_unfelt(i)) search_for_any_of(work, i);
  }
  settle_open_sides(work);
}

}  // namespace palpate::regions
