// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/motion.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

/// Where there is no room for what comes near on a region's course, the next one is so much
/// shorter, down to a tick or so, and where there is again, longer.
constexpr float kShorter = 0.5f;
constexpr float kShortest = 0.125f;
constexpr float kLonger = 1.2f;
/// Where what a search keeps does not do for this share of a tick, so many keep nothing.
constexpr double kLeastLasting = 0.5;
constexpr std::uint32_t kBareSearches = 8;
/// Farther ahead, what comes near on the way costs more than the longer rest saves.
constexpr double kTicksAhead = 8;
/// Nor than so many delta: fast bodies do not go straight for long.
constexpr double kFarthestAhead = 0.2;

/// A course that a region is about to go.
///
/// Bodies that touch slide along each other farther than they move apart or together, and a step is
/// much like the one before. A proof for one place would be worth the less the farther a region
/// goes, whichever way; one for all places on its way lasts while the region keeps to it, and what
/// the region only passes by does not count (swept volumes; Redon, Kheddar and Coquillart 2002
/// bound boxes so between two poses, to find a first contact).
struct Course {
  Vec3d way{};     ///< of its centre, in the coordinates of b, from the present place
  float away = 0;  ///< how far that takes the region from its witness, in units
};

/// Which way a region's witness lies, from b; 0 where that is not known.
Vec3d way_of_witness(const Work& work, const Active& item) noexcept {
  return item.way.is_of(work.witness_of(item)) ? vec_cast<double>(item.way.along) : Vec3d{};
}

/// The course of a region for the ticks to come. None where bodies are too fast, stand still or
/// have just jumped, or where nothing that is kept of the region would last. What brings a region
/// nearer to its witness is left out: while that comes nearer no less than anything else, the
/// interval between them grows no wider. O(1)
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

Reach reach_of(const Work& work, const Active& item, const Course& course) noexcept {
  const PairState& pair = work.pair_of(item);
  const float margin = work.keeps_nothing(item) ? 0.0f : static_cast<float>(margin_of(pair));
  return {static_cast<float>(pair.delta) + kClosed, margin + course.away,
          vec_cast<float>((1 / pair.scale_b) * course.way), kClosed - kRounding};
}

/// @return false where the budget has ended it
bool search_along(Work& work, Active& item, const Course& course) noexcept {
  MinimaMemory& memory = work.memory;
  const Bounds found = search(*memory.kernels, work.frame_of(item), *memory.search, work.pace,
                              item.region, work.witness_of(item), reach_of(work, item, course));
  work.witness_of(item) = found.best;
  work.searches += found.complete ? 1u : 0u;
  if (found.rest > item.rest) {
    item.rest = found.rest;
    item.moved = 0;
    RegionPairs& kept = work.kept_of(item);
    kept.near.take(memory.search->near);
    prove(work.state_of(item), kept, work.pair_of(item), item.region, found.rest, course.way);
  }
  work.widen(item);
  return found.complete || found.crowded;
}

void see_how_long_it_lasts(const Work& work, const Active& item) noexcept {
  const PairState& pair = work.pair_of(item);
  if (item.width > kClosed || !(margin_of(pair) > 0)) return;
  RegionState& state = work.state_of(item);
  const auto room = static_cast<double>(item.rest - work.upper_of(item));
  if (state.bare_searches > 0) {
    --state.bare_searches;
  } else if (room < kLeastLasting * last_motion(pair)) {
    state.bare_searches = kBareSearches;
    state.ahead = kShortest;
  }
}

}  // namespace

void close(Work& work, Active& item) noexcept {
  if (item.width <= kClosed) return;
  const Course course = course_ahead(work, item);
  if (!search_along(work, item, course)) return;
  if (squared_norm(course.way) > 0) {
    float& ahead = work.state_of(item).ahead;
    if (item.width <= kClosed) {
      ahead = ahead < 1 / kLonger ? kLonger * ahead : 1;
      return;
    }
    // More comes near on the way than there is room for: of the present place alone, all is kept.
    ahead = ahead > kShortest / kShorter ? kShorter * ahead : kShortest;
    search_along(work, item, {});
  }
  see_how_long_it_lasts(work, item);
}

}  // namespace palpate::regions
