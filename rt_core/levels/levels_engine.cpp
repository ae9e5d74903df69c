// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/levels_engine.hpp"

#include "rt_core/levels/interpolate.hpp"
#include "rt_core/levels/refine.hpp"
#include "rt_core/levels/start.hpp"
#include "rt_core/levels/upkeep.hpp"
#include "rt_core/levels/work.hpp"

namespace palpate::levels {
namespace {

bool is_approximate(const Work& work, const Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  return is_simplified(piece_a(pair, node)) || is_simplified(piece_b(pair, node));
}

/// What still waits is not resolved; nor are stopped nodes, which stand for original surface that
/// is somewhere within their bounds.
void settle(Work& work) noexcept {
  for (const Waiting& item : work.waiting.items()) work.leave(item.node, item.lower_m);
  for (const std::uint32_t index : work.stopped.all()) {
    const Node& node = work.tree[index];
    if (work.tree.in_front(index) && is_approximate(work, node)) {
      work.leave_unresolved(work.certain_m(node), node);
    }
  }
}

QueryResult finish(Work& work) noexcept {
  work.report.finish(work.result);
  work.result.queries = work.probe.queries();
  work.result.iteration_cap_met |= work.probe.iteration_cap_met();
  return work.result;
}

}  // namespace

QueryResult query(QueryMemory& memory, const Rules& rules, Meter& meter, Tally& tally) noexcept {
  ++memory.ticks;
  Work work(memory, rules, meter, tally);
  start(work);
  tally.lap(Stage::start, meter);
  refine(work);
  tally.lap(Stage::refine, meter);
  if (!work.result.truncated_by_time && !work.result.truncated_by_units) {
    if (rules.interpolate && !rules.exact) interpolate(work);
    tally.lap(Stage::interpolate, meter);
    raise(work);
    tighten(work);
    tally.lap(Stage::upkeep, meter);
  }
  meter.begin_tail();
  settle(work);
  const QueryResult found = finish(work);
  tally.lap(Stage::settle, meter);
  return found;
}

}  // namespace palpate::levels
