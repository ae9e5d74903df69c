// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/minima.hpp"

#include "rt_core/base/queue.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

struct WiderInterval {
  const Work& work;
  bool operator()(std::uint32_t a, std::uint32_t b) const noexcept {
    const float of_a = work.active()[a].width;
    const float of_b = work.active()[b].width;
    return of_a > of_b || (of_a == of_b && a < b);
  }
};

void close_all(Work& work) noexcept {
  std::uint32_t open = 0;
  for (std::uint32_t i = 0; i < work.count; ++i) {
    if (work.active()[i].width > kClosed) work.memory.queue[open++] = i;
  }
  MinQueue<std::uint32_t, WiderInterval> widest(work.memory.queue.first(open), WiderInterval{work});
  widest.fill();
  for (; !widest.empty() && work.pace.go_on(); widest.pop()) {
    close(work, work.active()[widest.top()]);
  }
}

/// What is not proved.
void certify(Work& work) noexcept {
  MinimaResult& result = work.result;
  bool open = false;
  for (const Active& item : work.active()) {
    const levels::PairState& pair = work.pair_of(item);
    const Witness& witness = work.witness_of(item);
    const float upper = witness.known() ? witness.distance - kRounding : work.delta_of(item);
    const float lower = item.rest < upper ? item.rest : upper;
    const double lower_m = static_cast<double>(lower > 0 ? lower : 0) * pair.unit_m;
    if (lower < work.delta_of(item) && lower_m < result.unresolved_lower_m) {
      result.unresolved_lower_m = lower_m;
    }
    if (!(item.width > kClosed)) continue;
    open = true;
    const double size = static_cast<double>(pair.image_a->regions[item.region].radius);
    result.s_worst = size > result.s_worst ? size : result.s_worst;
  }
  result.truncated_by_units = open && work.pace.units_ended();
  result.truncated_by_time = open && work.pace.time_ended();
}

}  // namespace

MinimaResult find_minima(MinimaMemory& memory, Meter& meter, Tally& tally) noexcept {
  Work work(memory, meter);
  gather(work);
  close_all(work);
  certify(work);
  report(work);
  work.result.near_regions = work.count;
  tally.count([&](auto& counters) {
    counters.near_regions += work.count;
    counters.searches += work.searches;
    counters.sweeps += work.swept ? 1u : 0u;
  });
  return work.result;
}

}  // namespace palpate::regions
