// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/certify.hpp"

#include "rt_core/regions/containment.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

/// What is known of a region's depth. Float's delta may be the larger by rounding.
double depth_of(const Work& work, const Active& item) noexcept {
  const double depth = work.pair_of(item).delta - static_cast<double>(work.upper_of(item));
  return depth > 0 ? depth : 0;
}

/// By how much wider its interval is below delta for the bodies as they were before detail was
/// left out of them.
double left_out_m(const Work& work, const Active& item) noexcept {
  const PairState& pair = work.pair_of(item);
  const double depth = depth_of(work, item);
  const double above = depth < pair.deviation ? depth : pair.deviation;
  return (pair.deviation + above) * pair.unit_m;
}

double not_felt_m(const Work& work, const Active& item) noexcept {
  const auto absence = static_cast<double>(work.memory.crowd.absence[item.state]);
  return absence * depth_of(work, item) * work.pair_of(item).unit_m;
}

}  // namespace

void certify(Work& work) noexcept {
  QueryResult& result = work.result;
  for (const Active& item : work.active()) {
    const PairState& pair = work.pair_of(item);
    const Witness& witness = work.witness_of(item);
    const float upper = witness.known() ? witness.distance - kRounding : work.delta_of(item);
    const float lower = item.rest < upper ? item.rest : upper;
    const double lower_m = static_cast<double>(lower > 0 ? lower : 0) * pair.unit_m;
    if (lower < work.delta_of(item) && lower_m < result.unresolved_lower_m) {
      result.unresolved_lower_m = lower_m;
    }
    result.open_m += work.width_m(item) + left_out_m(work, item) + not_felt_m(work, item);
    const double size = static_cast<double>(pair.image_a->regions[item.region].radius);
    if (item.width > kClosed && size > result.s_worst) result.s_worst = size;
  }
  if (may_be_inside(work)) result.unresolved_lower_m = 0;
}

}  // namespace palpate::regions
