// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/regions_engine.hpp"

#include "rt_core/regions/certify.hpp"
#include "rt_core/regions/gather.hpp"
#include "rt_core/regions/narrow.hpp"
#include "rt_core/regions/report.hpp"
#include "rt_core/regions/reserve.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

/// Everything up to here was refinement; what it left to the tail is to be had now.
void end_refinement(Work& work) noexcept {
  work.result.truncated_by_units |= work.truncated && work.pace.units_ended();
  work.result.truncated_by_time |= work.truncated && work.pace.time_ended();
  work.meter.begin_tail();
  const std::uint64_t used = work.pace.used();
  if (used > 0) palpate::follow(work.memory.pursuit.unit_ns, work.meter.refined_ns() / used);
  work.pace.resume();
}

void finish(Work& work, Tally& tally) noexcept {
  QueryResult& result = work.result;
  result.queries = work.pace.used();
  result.near_regions = work.count;
  result.truncated_by_units |= work.pace.units_ended();
  result.truncated_by_time |= work.pace.time_ended() || work.memory.crowd.thinned;
  tally.count([&](auto& counters) {
    counters.near_regions += work.count;
    counters.searches += work.searches;
    counters.sweeps += work.swept ? 1u : 0u;
    counters.follows += work.followed ? 1u : 0u;
  });
}

}  // namespace

QueryResult query(QueryMemory& memory, const Demand& demand, Meter& meter, Tally& tally) noexcept {
  Work work(memory, demand, meter);
  gather(work);
  settle_sides(work);
  tally.lap(Stage::start, meter);
  narrow(work);
  decide_on_reserve(work);
  find_ways_out(work);
  end_refinement(work);
  tally.lap(Stage::refine, meter.refined_ns());
  certify(work);
  report(work);
  finish(work, tally);
  tally.lap(Stage::settle, meter);
  return work.result;
}

}  // namespace palpate::regions
