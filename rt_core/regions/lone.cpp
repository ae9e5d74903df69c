// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/lone.hpp"

#include "rt_core/geometry/directions.hpp"
#include "rt_core/regions/witness_batch.hpp"

namespace palpate::regions {
namespace {

/// @return false where the budget has ended
bool measure_felt(Work& work) noexcept {
  WitnessBatch batch(work);
  std::uint32_t felt = 0;
  for (std::uint32_t i = 0; i < work.count; ++i) {
    if (!work.is_felt(work.active()[i])) continue;
    if (felt++ % kBatch == 0 && !work.pace.go_on()) return false;
    batch.add(i);
  }
  batch.measure_all();
  return true;
}

/// World axes; zero where it crosses.
Vec3d direction_of(const Work& work, const Active& item) noexcept {
  const levels::PairState& pair = work.pair_of(item);
  return pair.rotation_a * (pair.b_in_a.rotation * vec_cast<double>(item.way.along));
}

}  // namespace

void tell_lone(Work& work) noexcept {
  if (!measure_felt(work)) return;
  Directions directions;
  for (const Active& item : work.active()) {
    if (!work.is_felt(item)) continue;
    directions.add(direction_of(work, item), static_cast<double>(work.mass_of(item)));
  }
  float sum = 0;
  float felt = 0;
  for (Active& item : work.active()) {
    if (!work.is_felt(item)) continue;
    const auto around = static_cast<float>(directions.around(direction_of(work, item)));
    const float own = work.mass_of(item);
    item.lone = 1 / (around > own ? around : own);  // less is rounding
    sum += item.lone;
    ++felt;
  }
  for (Active& item : work.active()) {
    if (work.is_felt(item)) item.lone *= felt / sum;
  }
}

}  // namespace palpate::regions
