// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/close.hpp"

#include "rt_core/regions/course.hpp"
#include "rt_core/regions/motion.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

/// An interval is closed to this share of its width at a time, and for good once it is narrower
/// than a share of delta.
constexpr float kStep = 0.3f;
constexpr float kLastStep = 0.1f;
/// Where an interval may stay open, a search leaves this share of that to motion, unless it is
/// fast.
constexpr float kRestShare = 0.6f;
/// Where there is no room for what comes near on a region's course, the next one is so much
/// shorter, down to a tick or so, and where there is again, longer.
constexpr float kShorter = 0.5f;
constexpr float kShortest = 0.125f;
constexpr float kLonger = 1.2f;
/// Where what a search keeps does not do for this share of a tick, so many keep nothing.
constexpr double kLeastLasting = 0.5;
constexpr std::uint32_t kBareSearches = 8;

/// Reach::margin of a search whose interval may stay open by the tolerance.
/// @param away  how far the region will go from its witness, which may open the interval as well
float margin_within(const Work& work, const Active& item, float tolerance, float away) noexcept {
  // The search's bound gives away kRounding, which is part of the interval.
  const float room = tolerance > kRounding ? tolerance - kRounding : 0;
  auto margin = work.keeps_nothing(item) ? 0.0f : static_cast<float>(margin_of(work.pair_of(item)));
  const bool slow = margin > 0;
  const bool anew = item.rest <= 0;  // a first answer soon
  if (slow && !anew && !work.demand.limited && margin < kRestShare * room) {
    margin = kRestShare * room;
  }
  return margin - room + (away > room ? away - room : 0);
}

/// The interval after which a course is worth its search.
float widest_within(float tolerance) noexcept {
  return (tolerance > kClosed ? tolerance : kClosed) - kRounding;
}

/// Searches a region from where a tick before had to leave off, or from the start. What the budget
/// leaves of it is kept, unless another search is.
Bounds search_on(Work& work, const Active& item, const Reach& reach, Vec3d course) noexcept {
  QueryMemory& memory = work.memory;
  Unfinished& kept = *memory.unfinished;
  const bool begun = kept.state == item.state;
  const PairState& pair = work.pair_of(item);
  RegionState& state = work.state_of(item);
  const double before = begun ? kept.spent : 0;
  const std::uint64_t used = work.pace.used();
  const Bounds found =
      begun ? go_on_searching(*memory.kernels, work.frame_of(item), *memory.search, work.pace,
                              work.witness_of(item), reach, moved_since(kept.at, pair, item.region),
                              kept.left)
            : search(*memory.kernels, work.frame_of(item), *memory.search, work.pace, item.region,
                     work.witness_of(item), reach, kept.any() ? nullptr : &kept.left);
  const double spent = before + static_cast<double>(work.pace.used() - used);
  const bool has_first = reach.first && found.best.known();
  if (begun && (found.complete || found.crowded)) kept.drop();
  if (found.crowded) return found;
  if (found.complete) {
    if (reach.first) return found;
    memory.pursuit.learn_search(spent);
    state.cost = static_cast<float>(spent);
    ++work.searches;
  } else if (begun || (!has_first && !kept.any())) {
    kept.state = item.state;
    kept.at = stand_of(pair, item.region, course);
    kept.spent = spent;
  }
  return found;
}

Vec3f in_image(const PairState& pair, Vec3d way) noexcept {
  return vec_cast<float>((1 / pair.scale_b) * way);
}

/// @param first  ends as soon as a pair nearer than delta is known
/// @return false where the budget ended it
bool search_along(Work& work, Active& item, float tolerance, bool first,
                  const Course& course) noexcept {
  QueryMemory& memory = work.memory;
  const PairState& pair = work.pair_of(item);
  RegionState& state = work.state_of(item);
  const Reach reach{static_cast<float>(pair.delta) + kClosed,
                    margin_within(work, item, tolerance, course.away),
                    first,
                    work.room,
                    in_image(pair, course.way),
                    widest_within(tolerance)};
  const std::uint64_t before = work.pace.used();
  const bool known = work.witness_of(item).known();
  const float upper = work.upper_of(item);
  const Bounds found = search_on(work, item, reach, course.way);
  const auto spent = static_cast<double>(work.pace.used() - before);
  work.witness_of(item) = found.best;
  if (known) {
    const auto nearer = static_cast<double>(upper - work.upper_of(item));
    memory.pursuit.search.add(nearer / pair.delta, spent);
  }
  work.truncated |= !found.complete && !work.pace.go_on();
  if (found.rest > item.rest) {
    item.rest = found.rest;
    item.moved = 0;
    RegionPairs& kept = work.kept_of(item);
    kept.near.take(memory.search->near);
    prove(state, kept, pair, item.region, found.rest, course.way);
  }
  work.widen(item);
  return found.complete || found.crowded;
}

Course course_of(const Work& work, const Active& item) noexcept {
  const Unfinished& kept = *work.memory.unfinished;
  return kept.state == item.state ? course_left(work, item, kept.at) : course_ahead(work, item);
}

/// Of an interval that a search has closed. Under a budget few of them are, and less is kept.
void see_how_long_it_lasts(const Work& work, const Active& item) noexcept {
  const PairState& pair = work.pair_of(item);
  if (work.demand.limited || item.width > kClosed || !(margin_of(pair) > 0)) return;
  RegionState& state = work.state_of(item);
  const auto room = static_cast<double>(item.rest - work.upper_of(item));
  if (state.bare_searches > 0) {
    --state.bare_searches;
  } else if (room < kLeastLasting * last_motion(pair)) {
    state.bare_searches = kBareSearches;
    state.ahead = kShortest;
  }
}

/// @param first  as search_along()
void search_region(Work& work, Active& item, float tolerance, bool first) noexcept {
  if (item.width <= kClosed && item.width <= tolerance) return;
  if (!work.pace.go_on()) {
    work.truncated = true;
    return;
  }
  const Course course = first ? Course{} : course_of(work, item);
  if (!search_along(work, item, tolerance, first, course) || first) return;
  if (squared_norm(course.way) > 0) {
    float& ahead = work.state_of(item).ahead;
    if (item.width <= tolerance || item.width <= kClosed) {
      ahead = ahead < 1 / kLonger ? kLonger * ahead : 1;
      return;
    }
    // More comes near on the way than there is room for: of the present place alone, all is kept.
    ahead = ahead > kShortest / kShorter ? kShorter * ahead : kShortest;
    search_along(work, item, tolerance, false, {});
  }
  see_how_long_it_lasts(work, item);
}

/// How wide a step leaves an interval.
float next_width(const Work& work, const Active& item, float tolerance) noexcept {
  const bool last = item.width <= kLastStep * work.delta_of(item);
  const float next = last ? 0 : kStep * item.width;
  return next > tolerance ? next : tolerance;
}

/// After which it has a witness, or an interval of this width.
void seek(Work& work, Active& item, float width) noexcept {
  const bool first = !work.witness_of(item).known();
  search_region(work, item, width, first);
  if (first && work.witness_of(item).known() && !work.truncated) climb_from_witness(work, item);
}

}  // namespace

void climb_from_witness(Work& work, Active& item, Beside* out_beside) noexcept {
  climb(*work.memory.kernels, work.frame_of(item), *work.memory.search, work.pace,
        work.witness_of(item), item.way, out_beside);
  item.climbed = true;
  work.truncated |= !work.pace.go_on();
  work.widen(item);
}

void close(Work& work, Active& item, float tolerance) noexcept {
  search_region(work, item, tolerance, false);
}

void search_for_any(Work& work, Active& item) noexcept { search_region(work, item, 0, true); }

void take_up(Work& work, Active& item, float tolerance) noexcept {
  if (work.may_climb(item)) climb_from_witness(work, item);
  seek(work, item, next_width(work, item, tolerance));
}

void step(Work& work, Active& item, float tolerance, bool at_once) noexcept {
  if (work.may_climb(item)) {
    climb_from_witness(work, item);
    return;
  }
  seek(work, item, at_once ? tolerance : next_width(work, item, tolerance));
}

}  // namespace palpate::regions
