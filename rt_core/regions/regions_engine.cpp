// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/regions_engine.hpp"

#include <limits>

#include "rt_core/base/queue.hpp"
#include "rt_core/regions/follow.hpp"
#include "rt_core/regions/pair_batch.hpp"
#include "rt_core/regions/report.hpp"

namespace palpate::regions {
namespace {

using levels::PairState;

/// Pairs that are farther than the nearest by less than this many ticks of the present motion are
/// kept, and so the region needs no search for as long; at most a share of delta, for what is
/// farther costs more than the rest saves; and not where that is no more than a few ticks.
constexpr double kRestTicks = 6;
constexpr double kFewestTicks = 3;
constexpr double kMostRest = 0.4;
constexpr double kLeastRest = 0.01;
/// A move by more than this (in units), or by this many delta where that is more, starts anew.
constexpr double kJump = 0.05;
constexpr double kJumpDelta = 2;
/// Under a budget an interval is closed to this share of its width at a time, and for good once it
/// is narrower than a share of delta.
constexpr float kStep = 0.3f;
constexpr float kLastStep = 0.1f;
/// But at once where the searches of all would take less than so many times what the tick has left:
/// steps see more of what a tick has no time for, and take half as much again.
constexpr double kAtOnce = 1.5;
/// What may cross the other body goes first, as if its interval were wider by so many delta: how
/// deep it would be is not in it. Not after a jump, when nothing is known of anything.
constexpr float kMayCross = 1;
/// So few regions are not thinned out: a force would miss any of them.
constexpr double kFewestFelt = 32;
/// What is not felt, because others beside it are, goes last.
constexpr float kNotFelt = 1e-3f;
/// Done in every tick, however late it is: one that does not get to search at all would find
/// nothing in the next one either.
constexpr std::uint64_t kLeastUnits = 64;
/// Where an interval may stay open, a search leaves this share of that to motion, unless it is
/// fast.
constexpr float kRestShare = 0.75f;
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
/// Then following takes this share of what is left, the larger where it brings witnesses nearer
/// for the same work than searches do: by half as much, for it also keeps them there.
constexpr double kMostFollow = 0.85;
constexpr double kLeastFollow = 0.05;
constexpr double kFollowWorth = 2;
/// In a tick, all regions together, in contact tolerances: less is what witnesses waver by.
constexpr double kLeastGain = 0.006;
/// Neighbours of a witness farther than this many delta are not looked at.
constexpr float kClimbReach = 2;

/// Rounded towards minus infinity far enough for float.
float float_below(double v) noexcept { return static_cast<float>(v - 1e-7 * (v < 0 ? -v : v)); }

class Query {
 public:
  Query(QueryMemory& memory, const Demand& demand, Meter& meter) noexcept
      : memory_(memory), demand_(demand), meter_(meter), pace_(meter) {
    result_.min_distance_m = std::numeric_limits<double>::infinity();
    result_.unresolved_lower_m = std::numeric_limits<double>::infinity();
  }

  QueryResult run() noexcept {
    for (std::uint32_t i = 0; i < memory_.pairs.size(); ++i) gather(i);
    measure_witnesses();
    measure_near_pairs();
    thin_out_crowd();
    widen_all();
    for (std::uint32_t i = 0; i < memory_.pairs.size(); ++i) settle_side(i);
    refine();
    for (std::uint32_t i = 0; i < memory_.pairs.size(); ++i) find_way_out(i);
    result_.truncated_by_units = truncated_ && pace_.units_ended();
    result_.truncated_by_time = truncated_ && pace_.time_ended();
    meter_.begin_tail();
    learn_time();
    pace_.resume();
    certify();
    report(memory_, active(), pace_, result_);
    result_.queries = pace_.used();
    result_.near_regions = count_;
    result_.truncated_by_units |= pace_.units_ended();
    result_.truncated_by_time |= pace_.time_ended() || memory_.crowd.thinned;
    return result_;
  }

 private:
  /// By what its force may still change by, for what it may stay open by. Of equal ones, as after a
  /// jump, neighbours are far apart in the order, so that a budget which ends early has seen
  /// something of everywhere.
  struct Wider {
    std::span<const Active> active;
    static std::uint32_t scattered(std::uint32_t i) noexcept { return i * 0x9e3779b1u; }
    bool operator()(std::uint32_t a, std::uint32_t b) const noexcept {
      const float of_a = active[a].urgency;
      const float of_b = active[b].urgency;
      return of_a > of_b || (of_a == of_b && scattered(a) < scattered(b));
    }
  };

  PairState& pair_of(const Active& item) noexcept { return memory_.pairs[item.pair]; }
  const PairFrame& frame_of_item(const Active& item) noexcept { return memory_.frames[item.pair]; }
  RegionState& state_of(const Active& item) noexcept { return memory_.states[item.state]; }
  std::span<Active> active() noexcept { return memory_.active.first(count_); }

  /// After a jump the bounds say nothing and the witnesses little.
  void sweep_if_lost(std::uint32_t index) noexcept {
    PairState& pair = memory_.pairs[index];
    const double far = kJumpDelta * pair.delta > kJump ? kJumpDelta * pair.delta : kJump;
    if (!pair.fresh && last_motion(pair) <= far) return;
    pair.fresh = false;
    swept_ = true;
    memory_.containment[index].doubtful = true;
    const std::span<float> swept = memory_.swept.first(pair.image_a->regions.size());
    sweep(*memory_.kernels, memory_.frames[index], *memory_.search, pace_,
          static_cast<float>(pair.delta + margin_of(pair)), swept);
    for (std::uint32_t i = 0; i < swept.size(); ++i) {
      RegionState& state = memory_.states[memory_.first_state[index] + i];
      state.near.count = 0;
      state.seeds.count = 0;
      prove(state, pair, i, sqrt_of(swept[i]) - kRounding);
    }
  }

  /// Of any point of a, at most.
  static double last_motion(const PairState& pair) noexcept {
    return pair.last_travel + pair.last_turn * pair.scale_a;
  }

  /// How far a region's rest is looked for.
  static double margin_of(const PairState& pair) noexcept {
    const double tick = last_motion(pair);
    const double most = kMostRest * pair.delta;
    if (kFewestTicks * tick > most) return 0;
    const double wanted = kRestTicks * tick;
    const double least = kLeastRest * pair.delta;
    return wanted > most ? most : wanted > least ? wanted : least;
  }

  /// The regions of a pair that may be nearer than delta.
  void gather(std::uint32_t index) noexcept {
    const PairState& pair = memory_.pairs[index];
    memory_.frames[index] = frame_of(pair);
    sweep_if_lost(index);
    const std::uint32_t first = memory_.first_state[index];
    const auto regions = pair.image_a->regions;
    const double far = pair.delta + pair.deviation;
    for (std::uint32_t i = 0; i < regions.size(); ++i) {
      const RegionState& state = memory_.states[first + i];
      if (static_cast<double>(state.lower) - way_since(state, pair) >= far) continue;
      const double moved_by = moved_since(state, pair, i);
      const double lower = static_cast<double>(state.lower) - moved_by;
      if (lower >= pair.delta) {
        if (lower < far) result_.open_m += (far - lower) * pair.unit_m;
        continue;
      }
      Active& item = memory_.active[count_++];
      item.moved = static_cast<float>(moved_by);
      item.rest = float_below(static_cast<double>(state.rest) - moved_by);
      item.state = first + i;
      item.region = i;
      item.pair = index;
      item.weight = 1;
      item.climbed = false;
    }
  }

  void measure_witnesses() noexcept {
    PairBatch batch(memory_, active(), pace_,
                    [this](std::uint32_t i, const Witness& pair) { take_if_nearer(i, pair); });
    for (std::uint32_t i = 0; i < count_; ++i) {
      Witness& witness = state_of(active()[i]).witness;
      if (!witness.known()) continue;
      const Witness at_last = witness;
      const PairState& pair = pair_of(active()[i]);
      if (static_cast<double>(at_last.distance) <= last_motion(pair)) {
        memory_.containment[active()[i].pair].doubtful = true;
      }
      witness.distance = kFarthest;
      batch.add(i, at_last);
    }
    batch.measure_all();
  }

  /// Those of the near pairs that may be nearer than the witness now. Where the budget ends this,
  /// they count as not kept.
  void measure_near_pairs() noexcept {
    PairBatch batch(memory_, active(), pace_,
                    [this](std::uint32_t i, const Witness& pair) { take_if_nearer(i, pair); });
    for (std::uint32_t i = 0; i < count_; ++i) {
      Active& item = active()[i];
      const RegionState& state = state_of(item);
      const float upper = upper_of(item);
      for (std::uint32_t k = 0; k < state.near.count; ++k) {
        const Witness& pair = state.near.pairs[k];
        const float lower = pair.distance - item.moved;
        if (lower >= upper) break;
        if (!pace_.go_on()) {
          item.rest = lower - kRounding < item.rest ? lower - kRounding : item.rest;
          break;
        }
        if (!pair.same_pair(state.witness)) batch.add(i, pair);
      }
    }
    batch.measure_all();
  }

  /// To what the time after the searches does for, of which what crosses takes half at most. After
  /// a jump nobody knows yet who is felt.
  void thin_out_crowd() noexcept {
    const double all = meter_.contacts_affordable();
    if (all == std::numeric_limits<double>::infinity() || swept_) {
      memory_.crowd.gather_all();
      return;
    }
    std::uint64_t crossing = 0;
    for (const Active& item : active()) crossing += is_crossing(item) ? 1u : 0u;
    const auto taken = static_cast<double>(tail_contacts(0, crossing));
    const double most = taken < 0.5 * all ? all - taken : 0.5 * all;
    thin_out(memory_, active(), most > kFewestFelt ? most : kFewestFelt);
  }

  void take_if_nearer(std::uint32_t index, const Witness& pair) noexcept {
    Witness& witness = state_of(active()[index]).witness;
    if (pair.distance < witness.distance) witness = pair;
  }

  /// min(witness, delta)
  float upper_of(const Active& item) noexcept {
    const Witness& witness = state_of(item).witness;
    const auto delta = static_cast<float>(pair_of(item).delta);
    return witness.nearer_than(delta) ? witness.distance : delta;
  }

  bool is_crossing(const Active& item) noexcept { return state_of(item).witness.crosses(); }

  bool is_felt(const Active& item) noexcept {
    return upper_of(item) < static_cast<float>(pair_of(item).delta);
  }

  void widen(Active& item) noexcept {
    const float upper = upper_of(item);
    item.width = upper > item.rest ? upper - (item.rest > 0 ? item.rest : 0) : 0;
    const bool unknown = is_felt(item) || !state_of(item).witness.known();
    const bool may_cross = demand_.limited && !swept_ && item.rest <= 0 && unknown;
    const float doubt = may_cross ? kMayCross * static_cast<float>(pair_of(item).delta) : 0;
    item.urgency = item.width > kClosed ? (item.width + doubt) / item.weight : 0;
    if (!is_present(item)) item.urgency *= kNotFelt;
  }

  void widen_all() noexcept {
    for (Active& item : active()) widen(item);
  }

  bool crosses(std::uint32_t index) noexcept {
    for (const Active& item : active()) {
      if (item.pair == index && is_crossing(item)) return true;
    }
    return false;
  }

  /// Surfaces that cross have no inside to speak of, and are looked at once they have parted.
  void settle_side(std::uint32_t index) noexcept {
    Containment& kept = memory_.containment[index];
    if (!kept.doubtful || crosses(index)) return;
    const Side side = contained(*memory_.kernels, memory_.pairs[index], *memory_.search, pace_);
    kept.inside = side == Side::inside;
    kept.doubtful = side == Side::unknown;
    kept.nearest = {};
  }

  /// Inside, and no region near the surface: the nearest pair of all becomes the contact.
  void find_way_out(std::uint32_t index) noexcept {
    Containment& kept = memory_.containment[index];
    if (crosses(index)) {
      kept.inside = false;
      kept.doubtful = true;
    }
    if (!kept.inside || is_near(index)) return;
    const PairFrame& frame = memory_.frames[index];
    SearchScratch& scratch = *memory_.search;
    Witness best = kept.nearest;
    if (best.known()) {
      float distances[kBatch];
      scratch.batch_a[0] = best.a;
      scratch.batch_b[0] = best.b;
      measure(*memory_.kernels, frame, scratch, pace_, 1, distances);
      best.distance = distances[0];
    }
    for (std::uint32_t i = 0; i < frame.a->regions.size() && pace_.go_on(); ++i) {
      const Reach reach{best.known() ? best.distance : kFarthest, 0};
      const Bounds found = search(*memory_.kernels, frame, scratch, pace_, i, {}, reach);
      if (found.best.known() && found.best.distance < reach.limit) best = found.best;
    }
    kept.nearest = best;
    if (best.known()) activate(index, best);
  }

  bool is_near(std::uint32_t index) noexcept {
    for (const Active& item : active()) {
      if (item.pair == index && is_felt(item)) return true;
    }
    return false;
  }

  /// Makes a witness known to the report.
  void activate(std::uint32_t index, const Witness& witness) noexcept {
    const std::uint32_t region = memory_.frames[index].a->region_triangles[witness.a].region;
    const std::uint32_t state = memory_.first_state[index] + region;
    memory_.states[state].witness = witness;
    memory_.crowd.absence[state] = 0;
    for (const Active& item : active()) {
      if (item.state == state) return;
    }
    const auto rest = static_cast<float>(memory_.pairs[index].delta);
    memory_.active[count_++] = {.rest = rest, .state = state, .region = region, .pair = index};
  }

  void learn_time() noexcept {
    const std::uint64_t used = pace_.used();
    if (used > 0) palpate::follow(memory_.pursuit.unit_ns, meter_.refined_ns() / used);
  }

  void refine() noexcept {
    pace_.grant(kLeastUnits);
    if (demand_.limited || demand_.tolerance_m > 0) {
      refine_widest_first();
      return;
    }
    for (Active& item : active()) close(item, 0);
  }

  /// A region whose share of a tolerance is larger is searched less often. While intervals grow
  /// alike, all searches together are cheapest with shares in proportion to the root of what a
  /// search costs: least sum of cost / share for a given sum of shares.
  void share_tolerance() noexcept {
    if (demand_.tolerance_m <= 0) return;
    float sum = 0;
    float known = 0;
    for (const Active& item : active()) {
      sum += sqrt_of(state_of(item).cost);
      known += state_of(item).cost > 0 ? 1.0f : 0.0f;
    }
    for (Active& item : active()) {
      const float cost = state_of(item).cost;
      if (cost > 0) item.weight = sqrt_of(cost) * known / sum;
      widen(item);
    }
  }

  void refine_widest_first() noexcept {
    share_tolerance();
    const double share_m = count_ > 0 ? demand_.tolerance_m / count_ : 0;
    narrow_widest(share_m, demand_.limited);
    if (lags_) {
      follow_witnesses();
      narrow_widest(share_m, false);
    }
    memory_.pursuit.search.fade();
    memory_.pursuit.follow.fade();
    if (!truncated_) decide_crossings(share_m);
  }

  /// For most of the budget where that brings witnesses nearer, else for as much as it takes to
  /// see when it does. After a jump there is nothing to see yet.
  void follow_witnesses() noexcept {
    const Yield& by_search = memory_.pursuit.search;
    const Yield& by_follow = memory_.pursuit.follow;
    const double units = affordable();
    const bool worthwhile = by_follow.gain * units > kLeastGain * by_follow.units;
    const bool better = swept_ || (worthwhile && kFollowWorth * by_follow.gain * by_search.units >
                                                     by_search.gain * by_follow.units);
    follow(memory_, active(), (better ? kMostFollow : kLeastFollow) * units, pace_);
    widen_all();
  }

  /// Until the open intervals are within the tolerance or the budget ends.
  /// @param may_lag  or until it shows that searches do not keep up
  void narrow_widest(double share_m, bool may_lag) noexcept {
    MinQueue<std::uint32_t, Wider> queue(memory_.queue, Wider{active()});
    double open_m = 0;
    felt_ = crossing_ = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      open_m += width_m(active()[i]);
      count_in(active()[i]);
      queue.push(i);
    }
    leave_for_report();
    at_once_ = demand_.limited && memory_.pursuit.searches >= kFewSearches &&
               units_to_close() < kAtOnce * affordable();
    for (std::uint32_t step = 0; !queue.empty() && open_m > demand_.tolerance_m; ++step) {
      const std::uint32_t index = queue.top();
      Active& item = active()[index];
      if (may_lag && step % kStepsPerLook == 0 && lags()) return;
      queue.pop();
      if (item.width <= kClosed) break;
      open_m -= width_m(item);
      const std::uint64_t known = felt_ + crossing_;
      count_out(item);
      narrow(item, share_of(item, share_m));
      count_in(item);
      if (felt_ + crossing_ > known) leave_for_report();
      open_m += width_m(item);
      if (truncated_) return;
      queue.push(index);
    }
  }

  void count_in(const Active& item) noexcept {
    felt_ += is_felt(item) && is_present(item) ? 1u : 0u;
    crossing_ += is_crossing(item) ? 1u : 0u;
  }
  void count_out(const Active& item) noexcept {
    felt_ -= is_felt(item) && is_present(item) ? 1u : 0u;
    crossing_ -= is_crossing(item) ? 1u : 0u;
  }

  /// Time for all contacts, and units for the pairs of triangles that cross (report.hpp).
  void leave_for_report() noexcept {
    meter_.expect_contacts(tail_contacts(felt_, crossing_));
    meter_.set_aside(
        static_cast<std::uint64_t>(static_cast<double>(crossing_) * memory_.pursuit.listing_units));
  }

  /// About, of all open intervals.
  double units_to_close() noexcept {
    double units = 0;
    for (const Active& item : active()) {
      if (item.width <= kClosed || !is_present(item)) continue;
      const float cost = state_of(item).cost;
      units += cost > 0 ? static_cast<double>(cost) : memory_.pursuit.search_units;
    }
    return units;
  }

  /// Searches of all wide intervals that are felt take many times what the tick has left.
  bool lags() noexcept {
    if (swept_) return lags_after_jump();
    lags_ =
        memory_.pursuit.searches >= kFewSearches && units_to_search() > kManyTicks * affordable();
    return lags_;
  }

  bool lags_after_jump() noexcept {
    if (asked_ || searches_ < kFewAfterJump) return false;
    asked_ = true;
    lags_ = affordable() > kUnitsToFollow * count_ &&
            units_to_search() > kManyTicksAfterJump * affordable();
    return lags_;
  }

  double units_to_search() noexcept {
    std::uint32_t wide = 0;
    for (const Active& item : active()) {
      const float most = kWide * static_cast<float>(pair_of(item).delta);
      wide += is_felt(item) && is_present(item) && item.width > most ? 1u : 0u;
    }
    return wide * memory_.pursuit.search_units;
  }

  bool is_present(const Active& item) noexcept { return memory_.crowd.has(item.state); }

  /// Work units that the tick has left, about.
  double affordable() const noexcept { return meter_.queries_affordable(memory_.pursuit.unit_ns); }

  /// An interval may stay open by this much, but not down to zero: what crosses has a depth, of
  /// which the interval says nothing.
  float share_of(const Active& item, double share_m) noexcept {
    const float share = item.weight * static_cast<float>(share_m / pair_of(item).unit_m);
    const float half = 0.5f * upper_of(item);
    return share < half ? share : half;
  }

  /// Regions of which a part not looked at may cross the other body by now.
  void decide_crossings(double share_m) noexcept {
    for (Active& item : active()) {
      if (item.rest <= 0 && item.width > kClosed) close(item, share_of(item, share_m));
    }
  }

  /// One step. Under a budget that may end any moment, the cheap ones first: a witness is sought,
  /// then moved to a nearer one, then the region is searched, by and by.
  void narrow(Active& item, float share) noexcept {
    if (!demand_.limited) {
      close(item, share);
      return;
    }
    const Witness& witness = state_of(item).witness;
    const auto delta = static_cast<float>(pair_of(item).delta);
    if (witness.known() && !item.climbed && witness.distance < kClimbReach * delta) {
      climb_from_witness(item);
      return;
    }
    const bool first = !witness.known();
    const bool in_steps = !at_once_ && item.width > kLastStep * delta;
    const float step = in_steps ? kStep * item.width : 0;
    close(item, step > share ? step : share, first);
    if (first && witness.known() && !truncated_) climb_from_witness(item);
  }

  void climb_from_witness(Active& item) noexcept {
    climb(*memory_.kernels, frame_of_item(item), *memory_.search, pace_, state_of(item).witness);
    item.climbed = true;
    truncated_ |= !pace_.go_on();
    widen(item);
  }

  double width_m(const Active& item) noexcept {
    return static_cast<double>(item.width) * pair_of(item).unit_m;
  }

  /// By how much wider its interval is below delta for the bodies as they were before detail was
  /// left out of them.
  double left_out_m(const Active& item) noexcept {
    const PairState& pair = pair_of(item);
    const double below_delta = pair.delta - static_cast<double>(upper_of(item));
    const double above = below_delta < pair.deviation ? below_delta : pair.deviation;
    return (pair.deviation + above) * pair.unit_m;
  }

  /// How much of what is known of its depth is not felt.
  double not_felt_m(const Active& item) noexcept {
    const PairState& pair = pair_of(item);
    const double depth = pair.delta - static_cast<double>(upper_of(item));
    return static_cast<double>(memory_.crowd.absence[item.state]) * depth * pair.unit_m;
  }

  /// Searches a region until its interval is at most tolerance wide.
  /// @param first  or until a pair nearer than delta is known
  void close(Active& item, float tolerance, bool first = false) noexcept {
    if (item.width <= kClosed && item.width <= tolerance) return;
    if (!pace_.go_on()) {
      truncated_ = true;
      return;
    }
    const PairState& pair = pair_of(item);
    RegionState& state = state_of(item);
    const Reach reach{static_cast<float>(pair.delta) + kClosed, margin_within(item, tolerance),
                      first};
    const std::uint64_t before = pace_.used();
    const bool known = state.witness.known();
    const float upper = upper_of(item);
    const Bounds found = search(*memory_.kernels, frame_of_item(item), *memory_.search, pace_,
                                item.region, state.witness, reach);
    const auto spent = static_cast<double>(pace_.used() - before);
    if (!first && found.complete) {
      memory_.pursuit.learn_search(spent);
      state.cost = static_cast<float>(spent);
      ++searches_;
    }
    state.witness = found.best;
    if (known) {
      const auto nearer = static_cast<double>(upper - upper_of(item));
      memory_.pursuit.search.add(nearer / pair.delta, spent);
    }
    truncated_ |= !found.complete && !pace_.go_on();
    if (found.rest > item.rest) {
      item.rest = found.rest;
      item.moved = 0;
      state.near = memory_.search->near;
      prove(state, pair, item.region, found.rest);
    }
    widen(item);
  }

  /// Reach::margin of a search whose interval may stay open by the tolerance.
  float margin_within(const Active& item, float tolerance) noexcept {
    // The search's bound gives away kRounding, which is part of the interval.
    const float room = tolerance > kRounding ? tolerance - kRounding : 0;
    auto margin = static_cast<float>(margin_of(pair_of(item)));
    const bool slow = margin > 0;
    const bool anew = item.rest <= 0;  // a first answer soon
    if (slow && !anew && !demand_.limited && margin < kRestShare * room) margin = kRestShare * room;
    return margin - room;
  }

  void certify() noexcept {
    for (const Active& item : active()) {
      const PairState& pair = pair_of(item);
      const Witness& witness = state_of(item).witness;
      const float upper =
          witness.known() ? witness.distance - kRounding : static_cast<float>(pair.delta);
      const auto lower = static_cast<double>(item.rest < upper ? item.rest : upper);
      const double lower_m = (lower > 0 ? lower : 0) * pair.unit_m;
      if (lower < pair.delta && lower_m < result_.unresolved_lower_m) {
        result_.unresolved_lower_m = lower_m;
      }
      result_.open_m += width_m(item) + left_out_m(item) + not_felt_m(item);
      const double size = static_cast<double>(pair.image_a->regions[item.region].radius);
      if (item.width > kClosed && size > result_.s_worst) result_.s_worst = size;
    }
  }

  QueryMemory& memory_;
  Demand demand_;
  Meter& meter_;
  Pace pace_;
  std::uint32_t count_ = 0;  // of active regions
  bool truncated_ = false;
  bool lags_ = false;     // searches do not keep up
  bool swept_ = false;    // in this tick
  bool at_once_ = false;  // intervals are closed, not in steps
  bool asked_ = false;    // after a jump: whether searches will keep up
  std::uint32_t searches_ = 0;
  std::uint64_t felt_ = 0;      // of active regions
  std::uint64_t crossing_ = 0;  // likewise
  QueryResult result_;
};

}  // namespace

QueryResult query(QueryMemory& memory, const Demand& demand, Meter& meter) noexcept {
  return Query(memory, demand, meter).run();
}

}  // namespace palpate::regions
