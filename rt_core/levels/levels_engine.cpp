// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/levels_engine.hpp"

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

void refine_within_budget(Work& work) noexcept {
  refine(work);
  if (work.waiting.empty()) return;
  const bool by_units = work.meter.out_of_units();
  work.result.truncated_by_units |= by_units;
  work.result.truncated_by_time = !by_units;
}

/// What still waits is not resolved; nor are stopped nodes, which stand for original surface that
/// is somewhere within their bounds.
void settle(Work& work) noexcept {
  for (const Waiting& item : work.waiting.items()) work.leave(item.node, item.lower_m);
  for (const Waiting& item : work.waiting.items()) work.leave_doubtful(item.node);
  for (const std::uint32_t index : work.stopped.all()) {
    const Node& node = work.tree[index];
    if (is_approximate(work, node)) work.leave_unresolved(work.certified_m(node), node);
  }
}

void finish(Work& work) noexcept {
  work.report.finish(work.result);
  work.result.queries = work.probe.queries();
  work.result.iteration_cap_met |= work.probe.iteration_cap_met();
}

void run(QueryMemory& memory, const Rules& rules, Meter& meter, Tally& tally, Schedule schedule,
         QueryResult& out) noexcept {
  Work work(memory, rules, meter, tally, schedule);
  start(work);
  tally.lap(Stage::start, meter);
  refine_within_budget(work);
  tally.lap(Stage::refine, meter);
  if (!work.result.truncated_by_time && !work.result.truncated_by_units) {
    raise(work);
    tighten(work);
    tally.lap(Stage::upkeep, meter);
  }
  meter.begin_tail();
  settle(work);
  finish(work);
  out = work.result;
  tally.lap(Stage::settle, meter);
}

}  // namespace

QueryResult query(QueryMemory& memory, const Rules& rules, Meter& meter, Tally& tally) noexcept {
  const bool endless = rules.exact && !meter.limited();
  QueryResult found;
  if (endless && !memory.short_of_room) {
    run(memory, rules, meter, tally, Schedule::exhaustive, found);
    if (!found.truncated_by_memory) return found;
    // What is nearest gets the memory, from the roots on.
    for (PairState& pair : memory.pairs) pair.fresh = true;
  }
  const std::uint64_t spent = found.queries;
  run(memory, rules, meter, tally, Schedule::by_priority, found);
  found.queries += spent;
  memory.short_of_room = endless && found.truncated_by_memory;
  return found;
}

}  // namespace palpate::levels
