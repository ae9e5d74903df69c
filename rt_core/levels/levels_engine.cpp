// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/levels_engine.hpp"

#include "rt_core/levels/dive.hpp"
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

/// Refinement and dives share what is left of the budget, round by round; in the last round
/// refinement may have all of it. Exact queries do not dive.
constexpr std::uint32_t kRounds = 4;
constexpr std::uint64_t kDivesPart = 2;
/// No share of fewer queries pays for a search: refinement gets them all.
constexpr std::uint32_t kTooFewToShare = 8;

void hold_back(Work& work) noexcept {
  if (!work.rules.contact_dive || work.rules.exact || work.meter.queries_left() <= kTooFewToShare)
    return;
  work.meter.hold_back(kDivesPart);
}

void refine_and_dive(Work& work) noexcept {
  for (std::uint32_t round = 0; round < kRounds; ++round) {
    if (round + 1 < kRounds) hold_back(work);
    refine(work);
    work.meter.release();
    dive(work);
    if (work.waiting.empty() || work.out_of_budget()) break;
  }
  report_undived(work);
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
    if (work.tree.in_front(index) && is_approximate(work, node)) {
      work.leave_unresolved(work.certain_m(node), node);
    }
  }
}

void finish(Work& work) noexcept {
  work.report.finish(work.result);
  work.result.queries = work.probe.queries();
  work.result.iteration_cap_met |= work.probe.iteration_cap_met();
}

void run(QueryMemory& memory, const Rules& rules, Meter& meter, Tally& tally, Discipline discipline,
         QueryResult& out) noexcept {
  Work work(memory, rules, meter, tally, discipline);
  hold_back(work);  // where a tick starts depends on what refinement may spend
  start(work);
  meter.release();
  tally.lap(Stage::start, meter);
  refine_and_dive(work);
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
  finish(work);
  out = work.result;
  tally.lap(Stage::settle, meter);
}

}  // namespace

QueryResult query(QueryMemory& memory, const Rules& rules, Meter& meter, Tally& tally) noexcept {
  ++memory.ticks;
  const bool endless = rules.exact && !meter.limited();
  QueryResult found;
  if (endless && !memory.short_of_room) {
    run(memory, rules, meter, tally, Discipline::whole, found);
    if (!found.truncated_by_memory) return found;
    // What is nearest gets the memory, from the roots on.
    for (PairState& pair : memory.pairs) pair.fresh = true;
  }
  const std::uint64_t spent = found.queries;
  run(memory, rules, meter, tally, Discipline::by_worth, found);
  found.queries += spent;
  memory.short_of_room = endless && found.truncated_by_memory;
  return found;
}

}  // namespace palpate::levels
