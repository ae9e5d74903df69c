// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/course.hpp"

#include "rt_core/regions/motion.hpp"

namespace palpate::regions {
namespace {

/// Farther ahead, what comes near on the way costs more than the longer rest saves.
constexpr double kTicksAhead = 8;
/// Nor than so many delta: fast bodies do not go straight for long.
constexpr double kFarthestAhead = 0.2;

/// Which way a region's witness lies, from b; 0 where that is not known.
Vec3d way_of_witness(const Work& work, const Active& item) noexcept {
  return item.way.is_of(work.witness_of(item)) ? vec_cast<double>(item.way.along) : Vec3d{};
}

}  // namespace

Course course_ahead(const Work& work, const Active& item) noexcept {
  const levels::PairState& pair = work.pair_of(item);
  if (!(margin_of(pair) > 0) || work.keeps_nothing(item)) return {};
  const double ticks = kTicksAhead * static_cast<double>(work.state_of(item).ahead);
  Vec3d way = ticks * step_of(pair, item.region);
  const double length = norm(way);
  const double most = kFarthestAhead * pair.delta;
  if (length > most) way = (most / length) * way;
  const Vec3d apart = way_of_witness(work, item);
  const double along = dot(way, apart);
  if (along < 0) return {way - along * apart, 0};
  return {way, static_cast<float>(along)};
}

}  // namespace palpate::regions
