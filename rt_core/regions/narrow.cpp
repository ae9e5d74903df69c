// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/narrow.hpp"

#include <bit>
#include <functional>
#include <limits>

#include "rt_core/base/queue.hpp"
#include "rt_core/regions/close.hpp"
#include "rt_core/regions/follow.hpp"
#include "rt_core/regions/lone.hpp"
#include "rt_core/regions/motion.hpp"
#include "rt_core/regions/scout.hpp"
#include "rt_core/regions/survey.hpp"
#include "rt_core/regions/track.hpp"
#include "rt_core/regions/watch.hpp"

namespace palpate::regions {
namespace {

/// Done in every tick, however late it is.
constexpr std::uint64_t kLeastUnits = 64;
/// Intervals are closed at once where the searches of all would take less than so many times what
/// the tick has left: steps see more of what a tick has no time for, and take half as much again.
/// After a jump they are, too: what is near has been looked up by then.
constexpr double kAtOnce = 1.5;
/// Under a budget, searches do not keep up where those of the intervals wider than a share of delta
/// would take so many ticks; asked when so many searches have told what they take, and again every
/// few steps.
constexpr float kWide = 0.1f;
constexpr double kManyTicks = 10;
constexpr std::uint32_t kFewSearches = 4;
constexpr std::uint32_t kStepsPerLook = 4;
/// After a jump it is asked once, of the whole tick, as soon as so many regions have been searched;
/// and not where so few units are left for each that a dive and a climb are not to be had.
constexpr double kManyTicksAfterJump = 5;
constexpr std::uint32_t kFewAfterJump = 2;
constexpr double kUnitsToFollow = 16;
/// Where images can be looked up in, a survey takes the place of following, with this share of the
/// tick. So many searches tell whether one is due, or that they take more than their part of what
/// is left.
constexpr double kMostSurveyed = 0.97;
constexpr std::uint32_t kProbes = 3;
/// Then following takes this share of what is left, the larger where it brings witnesses nearer
/// for the same work than searches do: by half as much, for it also keeps them there.
constexpr double kMostFollow = 0.85;
constexpr double kLeastFollow = 0.05;
constexpr double kFollowWorth = 2;
/// In a tick, all regions together, in contact tolerances: less is what witnesses waver by.
constexpr double kLeastGain = 0.006;

/// A search goes on from the tick before for this share of what is left, the rest being for what is
/// new: and where what is left of it can make the interval narrower by this share at least, after
/// all motion since.
constexpr double kMostTakenUp = 0.5;
constexpr float kWorthTakingUp = 0.5f;

/// Units for a contact of bodies so fast that they feel none any more. Nearly all are found with a
/// quarter of these. Where there is none there are many places that are not quite near enough, and
/// other ones in every tick.
constexpr double kMostScouted = 200;

/// The turn of an active region, the least first: the more urgent ones, and of equally urgent ones,
/// as after a jump, neighbours far apart, so that a budget which ends early has seen something of
/// everywhere. One number, for a queue compares many.
constexpr std::uint32_t kScatter = 0x9e3779b1u;
constexpr std::uint32_t kGather = 0x0e8b2f51u;
static_assert(kScatter * kGather == 1);
/// @param urgency  >= 0: the bits of such floats are in their order
std::uint64_t turn_of(float urgency, std::uint32_t index) noexcept {
  return std::uint64_t{~std::bit_cast<std::uint32_t>(urgency)} << 32 | index * kScatter;
}
std::uint32_t index_of(std::uint64_t turn) noexcept {
  return static_cast<std::uint32_t>(turn) * kGather;
}

class Narrowing {
 public:
  explicit Narrowing(Work& work) noexcept : work_(work), pursuit_(work.memory.pursuit) {}

  void run() noexcept {
    if (work_.demand.limited && work_.count > 0) {
      if (!work_.anew) track(work_);
      if (!work_.swept) {
        scout_where_none_is_felt();
        settle_suspected_sides(work_);
      }
      if (work_.anew) {
        search_or_survey();
      } else if (!many_are_felt()) {
        watch(work_);
      }
    }
    begun_ = worth_taking_up();
    narrow_widest(work_.demand.limited && !lags_);
    if (lags_ && !work_.followed) {
      work_.followed = true;
      follow_witnesses();
      narrow_widest(false);
    }
    pursuit_.lagged = lags_;
    pursuit_.search.fade();
    pursuit_.follow.fade();
    if (!work_.truncated) decide_crossings();
    if (!work_.truncated) decide_contacts();
  }

 private:
  /// Fast bodies leave their contacts behind between two ticks.
  void scout_where_none_is_felt() noexcept {
    for (std::uint32_t i = 0; i < work_.memory.pairs.size() && work_.pace.go_on(); ++i) {
      if (margin_of(work_.memory.pairs[i]) > 0 || !work_.may_touch_unfelt(i)) continue;
      scout(work_, i, kMostScouted);
    }
    work_.truncated = !work_.pace.go_on();
  }

  /// An interval may stay open by this much, but not down to zero: what crosses has a depth, of
  /// which the interval says nothing. While nothing is felt none may: a tolerance is for how much
  /// is felt, not for whether anything is.
  float share_of(const Active& item) noexcept {
    if (felt_ == 0) return 0;
    const double mean_m = work_.demand.tolerance_m / work_.count;
    const float share = item.weight * static_cast<float>(mean_m / work_.pair_of(item).unit_m);
    const float half = 0.5f * work_.upper_of(item);
    return share < half ? share : half;
  }

  /// The region whose search the tick before has begun, kNone where there is none. It is dropped
  /// where too little of it holds any more, as when the bodies move fast.
  std::uint32_t worth_taking_up() noexcept {
    Unfinished& kept = *work_.memory.unfinished;
    const std::uint32_t i = kept.any() ? work_.active_of(kept.state) : image::kNone;
    if (i != image::kNone) {
      const Active& item = work_.active()[i];
      const levels::PairState& pair = work_.pair_of(item);
      const auto moved = static_cast<float>(moved_since(kept.at, pair, item.region));
      const float within = kept.left.seen - moved - item.rest;
      const bool open = item.width > kClosed && margin_of(pair) > 0;
      if (open && within > kWorthTakingUp * item.width) return i;
    }
    kept.drop();
    return image::kNone;
  }

  /// Until the open intervals are within the tolerance or the budget ends.
  /// @param may_lag  or until it shows that searches do not keep up
  void narrow_widest(bool may_lag) noexcept {
    if (begun_ != image::kNone) work_.active()[begun_].urgency = kFarthest;
    std::uint32_t open = 0;
    double open_m = 0;
    for (std::uint32_t i = 0; i < work_.count; ++i) {
      const Active& item = work_.active()[i];
      open_m += work_.width_m(item);
      if (item.width > kClosed) work_.memory.turns[open++] = turn_of(item.urgency, i);
    }
    count_all();
    if (open == 0 || open_m <= work_.demand.tolerance_m) return;
    // In a crowd putting them in order takes a while; often neither is there need of it nor time.
    if (may_lag && lags()) return;
    work_.truncated = !work_.pace.go_on();
    if (work_.truncated) return;
    MinQueue<std::uint64_t, std::less<>> queue(work_.memory.turns.first(open));
    queue.fill();
    const bool nearly_done =
        pursuit_.searches >= kFewSearches && units_to_close() < kAtOnce * affordable();
    const bool at_once = work_.demand.limited && (work_.anew || nearly_done);
    for (std::uint32_t step = 0; !queue.empty() && open_m > work_.demand.tolerance_m; ++step) {
      const std::uint32_t index = index_of(queue.top());
      Active& item = work_.active()[index];
      if (may_lag && step > 0 && step % kStepsPerLook == 0 && lags()) return;
      queue.pop();
      open_m -= work_.width_m(item);
      count_anew(item, [&] { narrow_one(index, at_once); });
      open_m += work_.width_m(item);
      if (work_.truncated) return;
      if (item.width > kClosed) queue.push(turn_of(item.urgency, index));
    }
  }

  void narrow_one(std::uint32_t index, bool at_once) noexcept {
    Active& item = work_.active()[index];
    if (index == begun_) {
      begun_ = image::kNone;
      work_.limit_to(kMostTakenUp);
      take_up(work_, item, share_of(item));
      work_.pace.no_limit();
      work_.truncated = !work_.pace.go_on();
    } else if (work_.demand.limited) {
      step(work_, item, share_of(item), at_once);
    } else {
      close(work_, item, share_of(item));
    }
  }

  /// For most of the budget where that brings witnesses nearer, else for as much as it takes to
  /// see when it does. After a jump there is nothing to see yet.
  void follow_witnesses() noexcept {
    if (!work_.anew && pursuit_.surveyed < 1 && survey(work_, kMostSurveyed)) {
      work_.widen_all();
      return;
    }
    const Yield& by_search = pursuit_.search;
    const Yield& by_follow = pursuit_.follow;
    const double units = affordable();
    const bool worthwhile = by_follow.gain * units > kLeastGain * by_follow.units;
    const bool better =
        work_.anew || (worthwhile && kFollowWorth * by_follow.gain * by_search.units >
                                         by_search.gain * by_follow.units);
    follow(work_, (better ? kMostFollow : kLeastFollow) * units);
    work_.widen_all();
  }

  /// After a jump all that may be near is searched, as long as the tick seems to do for the rest of
  /// it. From then on it is looked up, so that a tick in contact feels some of everywhere, and the
  /// nearest are what the rest of the tick is for.
  void search_or_survey() noexcept {
    if (!work_.pace.go_on() || !can_survey(work_)) return;
    count_all();
    if (search_while_it_lasts() || !work_.pace.go_on()) return;
    lags_ = work_.followed = true;
    if (!survey(work_, kMostSurveyed)) return;
    tell_lone(work_);
    work_.widen_all();
  }

  /// A few searches tell little of what the others take: it is asked again every few of them.
  /// @return whether all are done
  bool search_while_it_lasts() noexcept {
    const std::uint32_t count = work_.count;
    const std::uint32_t stride = even_stride(count);
    const std::uint64_t before = work_.pace.used();
    std::uint32_t done = 0;
    std::uint32_t at = 0;
    const auto search_next = [&] {
      Active& item = work_.active()[at];
      count_anew(item, [&] { close(work_, item, share_of(item)); });
      at = (at + stride) % count;
      ++done;
    };
    work_.limit_to(static_cast<double>(kProbes) / count);
    while (done < count && done < kProbes && work_.pace.go_on()) search_next();
    bool lasts = work_.pace.go_on();
    work_.pace.no_limit();
    work_.truncated = !work_.pace.go_on();
    while (lasts && done < count && work_.pace.go_on()) {
      search_next();
      if (done % kStepsPerLook != 0) continue;
      const double each = static_cast<double>(work_.pace.used() - before) / done;
      lasts = each * (count - done) < work_.units_left();
    }
    return done == count;
  }

  /// From region to region, so that each has its turn once, and those that follow each other lie
  /// apart: near the golden section of their number, and with no factor in common with it.
  static std::uint32_t even_stride(std::uint32_t count) noexcept {
    constexpr double kGolden = 0.6180339887498949;
    auto stride = static_cast<std::uint32_t>(kGolden * count) | 1u;
    while (common_factor(stride, count) > 1) stride += 2;
    return stride;
  }
  static std::uint32_t common_factor(std::uint32_t a, std::uint32_t b) noexcept {
    while (b > 0) {
      const std::uint32_t rest = a % b;
      a = b;
      b = rest;
    }
    return a;
  }

  /// Regions of which a part not looked at may cross the other body by now.
  void decide_crossings() noexcept {
    for (Active& item : work_.active()) {
      if (item.rest <= 0 && item.width > kClosed) close(work_, item, share_of(item));
    }
  }

  /// Each pair of bodies that feels nothing is searched until it does, or has nothing to feel.
  void decide_contacts() noexcept {
    const std::span<Active> active = work_.active();
    std::size_t end = 0;
    for (std::size_t first = 0; first < active.size(); first = end) {
      bool felt = false;
      for (end = first; end < active.size() && active[end].pair == active[first].pair; ++end) {
        felt |= work_.is_contact(active[end]);
      }
      for (std::size_t i = first; i < end && !felt && !work_.truncated; ++i) {
        close(work_, active[i], 0);
        felt = work_.is_contact(active[i]);
      }
    }
  }

  void count_all() noexcept {
    felt_ = crossing_ = wide_ = 0;
    for (const Active& item : work_.active()) count_in(item);
    leave_for_report();
  }
  /// A region that a function changes.
  void count_anew(const Active& item, auto change) noexcept {
    const std::uint64_t known = felt_ + crossing_;
    count_out(item);
    change();
    count_in(item);
    if (felt_ + crossing_ > known) leave_for_report();
  }
  void count_in(const Active& item) noexcept {
    felt_ += work_.is_contact(item) ? 1u : 0u;
    wide_ += counts_as_wide(item) ? 1u : 0u;
    crossing_ += work_.is_crossing(item) ? 1u : 0u;
  }
  void count_out(const Active& item) noexcept {
    felt_ -= work_.is_contact(item) ? 1u : 0u;
    wide_ -= counts_as_wide(item) ? 1u : 0u;
    crossing_ -= work_.is_crossing(item) ? 1u : 0u;
  }
  bool counts_as_wide(const Active& item) noexcept {
    return item.width > kWide * work_.delta_of(item) && work_.is_contact(item);
  }

  void leave_for_report() noexcept { work_.leave_for_report(felt_, crossing_); }

  float cost_of(const Active& item) noexcept { return work_.state_of(item).cost; }

  /// About, of all open intervals.
  double units_to_close() noexcept {
    double units = 0;
    for (const Active& item : work_.active()) {
      if (item.width <= kClosed || !work_.is_present(item)) continue;
      const float cost = cost_of(item);
      units += cost > 0 ? static_cast<double>(cost) : pursuit_.search_units;
    }
    return units;
  }

  /// Searches of all wide intervals that are felt take many times what the tick has left. Before
  /// any have told what they take, what a survey has found in the ticks before is all there is to
  /// go by: it goes on, and following comes after it, where many regions are felt.
  bool lags() noexcept {
    if (work_.anew) return lags_after_jump();
    lags_ = pursuit_.searches < kFewSearches ? pursuit_.lagged && many_are_felt()
                                             : units_to_search() > kManyTicks * affordable();
    return lags_;
  }

  /// A quarter of those with a witness. Else a few decide the force: searches find them, and what
  /// comes is watched for.
  bool many_are_felt() noexcept {
    std::uint32_t known = 0;
    std::uint32_t felt = 0;
    for (const Active& item : work_.active()) {
      known += work_.witness_of(item).known() ? 1u : 0u;
      felt += work_.is_felt(item) ? 1u : 0u;
    }
    return 4 * felt > known;
  }

  bool lags_after_jump() noexcept {
    if (asked_ || work_.searches < kFewAfterJump) return false;
    asked_ = true;
    lags_ = affordable() > kUnitsToFollow * work_.count &&
            units_to_search() > kManyTicksAfterJump * affordable();
    return lags_;
  }

  double units_to_search() const noexcept {
    return static_cast<double>(wide_) * pursuit_.search_units;
  }

  /// Work units that the tick has left, about.
  double affordable() const noexcept { return work_.meter.queries_affordable(pursuit_.unit_ns); }

  Work& work_;
  Pursuit& pursuit_;
  bool lags_ = false;                   // searches do not keep up
  bool asked_ = false;                  // after a jump: whether they will
  std::uint32_t begun_ = image::kNone;  // of active regions: the one that is to be taken up
  std::uint64_t felt_ = 0;              // of active regions
  std::uint64_t crossing_ = 0;          // likewise
  std::uint64_t wide_ = 0;              // of the felt ones: with wide intervals
};

}  // namespace

void narrow(Work& work) noexcept {
  if (!work.demand.limited || work.swept) work.memory.unfinished->drop();
  work.pace.grant(kLeastUnits);
  if (work.demand.limited || work.demand.tolerance_m > 0) {
    Narrowing(work).run();
    return;
  }
  for (Active& item : work.active()) close(work, item, 0);
}

}  // namespace palpate::regions
