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

void find_first_contact(Work& work, std::uint32_t pair) noexcept {
  scout(work, pair, kMostScouted);
  if (work.may_touch_unfelt(pair)) search_for_any_of(work, pair);
}

void draw_on_reserve(Work& work) noexcept {
  QueryResult& result = work.result;
  if (result.on_reserve) return;
  result.on_reserve = true;
  result.truncated_by_units = work.truncated && work.pace.units_ended();
  result.truncated_by_time = work.truncated && work.pace.time_ended();
  work.meter.draw_on_reserve();
  work.pace.resume();
}

}  // namespace

void decide_on_reserve(Work& work) noexcept {
  if (!work.demand.limited || !work.meter.has_reserve()) return;
  const std::span<const Active> active = work.active();
  std::size_t end = 0;
  for (std::size_t first = 0; first < active.size(); first = end) {  // of each pair
    bool open = false;
    bool felt = false;
    for (end = first; end < active.size() && active[end].pair == active[first].pair; ++end) {
      open |= active[end].width > kClosed;
      felt |= work.is_contact(active[end]);
    }
    if (!open || felt) continue;
    draw_on_reserve(work);
    find_first_contact(work, active[first].pair);
  }
  if (!may_touch_inside(work)) return;
  draw_on_reserve(work);
  settle_open_sides(work);
}

}  // namespace palpate::regions
