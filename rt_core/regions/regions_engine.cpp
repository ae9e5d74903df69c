// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/regions_engine.hpp"

#include <limits>

#include "rt_core/base/queue.hpp"

namespace palpate::regions {
namespace {

using image::RegionTriangle;
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
/// Rounding of the odometers, in units.
constexpr double kMotionSlack = 1e-7;
/// Under a budget an interval is closed to this share of its width at a time.
constexpr float kStep = 0.1f;
/// Below this an interval is closed: rounding leaves as much.
constexpr float kClosed = 2 * kRounding;
constexpr float kFarthest = 1e18f;

/// Rounded towards minus infinity far enough for float.
float float_below(double v) noexcept { return static_cast<float>(v - 1e-7 * (v < 0 ? -v : v)); }

Vec3d corner(const RegionTriangle& t, std::uint32_t i, double scale) noexcept {
  return scale * Vec3d{static_cast<double>(t.corners[3 * i]),
                       static_cast<double>(t.corners[3 * i + 1]),
                       static_cast<double>(t.corners[3 * i + 2])};
}

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
    refine();
    meter_.begin_tail();
    certify();
    report();
    result_.queries = pace_.used();
    result_.near_regions = count_;
    result_.truncated_by_units = truncated_ && pace_.units_ended();
    result_.truncated_by_time = truncated_ && pace_.time_ended();
    return result_;
  }

 private:
  struct Wider {
    std::span<const Active> active;
    bool operator()(std::uint32_t a, std::uint32_t b) const noexcept {
      return active[a].width > active[b].width || (active[a].width == active[b].width && a < b);
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
    if (!pair.fresh && pair.last_travel + pair.last_turn * pair.scale_a <= far) return;
    pair.fresh = false;
    const std::span<Swept> swept = memory_.swept.first(pair.image_a->regions.size());
    sweep(*memory_.kernels, memory_.frames[index], *memory_.search, pace_,
          static_cast<float>(pair.delta + margin_of(pair)), swept);
    for (std::uint32_t i = 0; i < swept.size(); ++i) {
      RegionState& state = memory_.states[memory_.first_state[index] + i];
      state.seed = swept[i].seed;
      state.near.count = 0;
      state.rest = state.lower = 0;
      prove(pair, i, state, sqrt_of(swept[i].squared) - kRounding);
    }
  }

  /// Of a region, in the coordinates of b.
  static Vec3d centre_of(const PairState& pair, std::uint32_t region) noexcept {
    const image::Region& r = pair.image_a->regions[region];
    const image::RegionNode& over = pair.image_a->region_nodes[r.parent];
    const Vec3d in_a = pair.scale_a * Vec3d{static_cast<double>(over.centre[0][r.slot]),
                                            static_cast<double>(over.centre[1][r.slot]),
                                            static_cast<double>(over.centre[2][r.slot])};
    return transpose(pair.b_in_a.rotation) * (in_a - pair.b_in_a.translation);
  }

  /// How far any point of a region has moved since the proof, at most.
  static double moved(const PairState& pair, std::uint32_t region,
                      const RegionState& state) noexcept {
    const double radius =
        pair.scale_a * static_cast<double>(pair.image_a->regions[region].radius);
    return norm(centre_of(pair, region) - state.centre) + (pair.turn - state.turn_at) * radius +
           kMotionSlack;
  }

  static void prove(const PairState& pair, std::uint32_t region, RegionState& state,
                    float rest) noexcept {
    state.rest = rest;
    state.lower = state.near.count > 0 && state.near.pairs[0].distance - kRounding < rest
                      ? state.near.pairs[0].distance - kRounding
                      : rest;
    state.centre = centre_of(pair, region);
    state.turn_at = pair.turn;
  }

  /// How far a region's rest is looked for.
  static double margin_of(const PairState& pair) noexcept {
    const double tick = pair.last_travel + pair.last_turn * pair.scale_a;
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
    for (std::uint32_t i = 0; i < regions.size(); ++i) {
      const RegionState& state = memory_.states[first + i];
      const double moved_by = moved(pair, i, state);
      if (static_cast<double>(state.lower) - moved_by >= pair.delta) continue;
      Active& item = memory_.active[count_++];
      item.moved = static_cast<float>(moved_by);
      item.rest = float_below(static_cast<double>(state.rest) - moved_by);
      item.state = first + i;
      item.region = i;
      item.pair = index;
    }
  }

  /// The witness of a region, and those of its near pairs that may be nearer now.
  void measure_witnesses() noexcept {
    for (std::uint32_t i = 0; i < count_; ++i) {
      Active& item = active()[i];
      if (pending_ > 0 && active()[pending_of_[0]].pair != item.pair) flush();
      RegionState& state = state_of(item);
      const Witness last = state.witness;
      state.witness.distance = kFarthest;
      if (last.known()) add_pending(i, last);
      float least = static_cast<float>(pair_of(item).delta);
      if (state.near.count > 0 && state.near.pairs[0].distance + item.moved < least) {
        least = state.near.pairs[0].distance + item.moved;
      }
      for (std::uint32_t k = 0; k < state.near.count; ++k) {
        const Witness& pair = state.near.pairs[k];
        if (pair.distance - item.moved >= least) break;
        if (!pair.same_pair(last)) add_pending(i, pair);
      }
    }
    if (pending_ > 0) flush();
    for (Active& item : active()) widen(item);
  }

  void add_pending(std::uint32_t item, const Witness& pair) noexcept {
    pending_of_[pending_] = item;
    memory_.search->batch_a[pending_] = pair.a;
    memory_.search->batch_b[pending_] = pair.b;
    if (++pending_ == kBatch) flush();
  }

  void flush() noexcept {
    float distances[kBatch];
    SearchScratch& scratch = *memory_.search;
    const Active& first = active()[pending_of_[0]];
    measure(*memory_.kernels, frame_of_item(first), scratch, pace_, pending_, distances);
    for (std::uint32_t i = 0; i < pending_; ++i) {
      Witness& witness = state_of(active()[pending_of_[i]]).witness;
      if (distances[i] < witness.distance) {
        witness = {scratch.batch_a[i], scratch.batch_b[i], distances[i]};
      }
    }
    pending_ = 0;
  }

  void climb_witnesses() noexcept {
    for (Active& item : active()) {
      Witness& witness = state_of(item).witness;
      const auto delta = static_cast<float>(pair_of(item).delta);
      if (!witness.known() || item.width <= kClosed || witness.distance >= 2 * delta) continue;
      climb(*memory_.kernels, frame_of_item(item), *memory_.search, pace_, witness);
      widen(item);
    }
  }

  void widen(Active& item) noexcept {
    const Witness& witness = state_of(item).witness;
    const auto delta = static_cast<float>(pair_of(item).delta);
    const float upper = witness.known() && witness.distance < delta ? witness.distance : delta;
    item.width = upper > item.rest ? upper - (item.rest > 0 ? item.rest : 0) : 0;
  }

  void refine() noexcept {
    if (demand_.limited || demand_.tolerance_m > 0) {
      climb_witnesses();
      refine_widest_first();
      return;
    }
    for (Active& item : active()) close(item, 0);
  }

  void refine_widest_first() noexcept {
    MinQueue<std::uint32_t, Wider> queue(memory_.queue, Wider{active()});
    double open_m = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      open_m += width_m(active()[i]);
      queue.push(i);
    }
    const double share_m = count_ > 0 ? demand_.tolerance_m / count_ : 0;
    while (!queue.empty() && open_m > demand_.tolerance_m) {
      const std::uint32_t index = queue.top();
      queue.pop();
      Active& item = active()[index];
      if (item.width <= kClosed) break;
      open_m -= width_m(item);
      if (state_of(item).seed != image::kNone) {
        dive_and_climb(item);
        open_m += width_m(item);
        if (truncated_) return;
        queue.push(index);
        continue;
      }
      const auto share = static_cast<float>(share_m / pair_of(item).unit_m);
      const float step = demand_.limited ? kStep * item.width : 0;
      close(item, step > share ? step : share);
      open_m += width_m(item);
      if (truncated_) return;
      queue.push(index);
    }
  }

  void dive_and_climb(Active& item) noexcept {
    RegionState& state = state_of(item);
    const PairFrame& frame = frame_of_item(item);
    Witness found = dive(*memory_.kernels, frame, *memory_.search, pace_, item.region, state.seed);
    state.seed = image::kNone;
    if (found.known()) climb(*memory_.kernels, frame, *memory_.search, pace_, found);
    const Witness& old = state.witness;
    if (found.known() && !(old.known() && old.distance < found.distance)) state.witness = found;
    truncated_ |= !pace_.go_on();
    widen(item);
  }

  double width_m(const Active& item) noexcept {
    return static_cast<double>(item.width) * pair_of(item).unit_m;
  }

  /// Searches a region until its interval is at most tolerance wide.
  void close(Active& item, float tolerance) noexcept {
    if (item.width <= kClosed && item.width <= tolerance) return;
    if (!pace_.go_on()) {
      truncated_ = true;
      return;
    }
    const PairState& pair = pair_of(item);
    RegionState& state = state_of(item);
    // The search's bound gives away kRounding, which is part of the interval.
    const float room = tolerance > kRounding ? tolerance - kRounding : 0;
    const Reach reach{static_cast<float>(pair.delta) + kClosed,
                      static_cast<float>(margin_of(pair)) - room};
    const Bounds found = search(*memory_.kernels, frame_of_item(item), *memory_.search, pace_,
                                item.region, state.witness, reach);
    state.witness = found.best;
    truncated_ |= !found.complete;
    if (found.rest > item.rest) {
      item.rest = found.rest;
      item.moved = 0;
      state.near = memory_.search->near;
      prove(pair, item.region, state, found.rest);
    }
    widen(item);
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
      result_.open_m += width_m(item);
      const double size = static_cast<double>(pair.image_a->regions[item.region].radius);
      if (item.width > kClosed && size > result_.s_worst) result_.s_worst = size;
    }
  }

  /// Witnesses nearer than delta become contacts, sixteen at a time.
  void report() noexcept {
    std::uint32_t batch[kBatch];
    std::uint32_t pending = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const Active& item = active()[i];
      const Witness& witness = state_of(item).witness;
      if (witness.known() && witness.distance < static_cast<float>(pair_of(item).delta)) {
        batch[pending++] = i;
      }
      if (pending == kBatch || (i + 1 == count_ && pending > 0)) {
        report_batch(batch, pending);
        pending = 0;
      }
    }
  }

  void report_batch(const std::uint32_t (&batch)[kBatch], std::uint32_t count) noexcept {
    Vec3d origin[kBatch];
    TriangleLanes& lanes = memory_.search->kernel.lanes;
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      origin[i] = place(active()[batch[i < count ? i : 0]], i, lanes);
    }
    WitnessLanes found;
    memory_.kernels->witnesses(memory_.search->kernel, found);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Active& item = active()[batch[i]];
      if ((found.crossing >> i & 1u) != 0) {
        report_crossing(item);
        continue;
      }
      const Vec3d on_a = origin[i] + lane(found.on_a, i);
      report_apart(item, on_a, lane(found.apart, i));
    }
  }

  static Vec3d lane(const float (&rows)[3][kBatch], std::uint32_t i) noexcept {
    return {static_cast<double>(rows[0][i]), static_cast<double>(rows[1][i]),
            static_cast<double>(rows[2][i])};
  }

  /// The witness's triangles in the coordinates of a, relative to a corner that is returned: in
  /// double up to there, so that only the size of the pair is rounded.
  Vec3d place(const Active& item, std::uint32_t i, TriangleLanes& lanes) noexcept {
    const PairState& pair = pair_of(item);
    const Witness& witness = state_of(item).witness;
    const RegionTriangle& a = pair.image_a->region_triangles[witness.a];
    const RegionTriangle& b = pair.image_b->region_triangles[witness.b];
    const Vec3d origin = corner(a, 0, pair.scale_a);
    for (std::uint32_t c = 0; c < 3; ++c) {
      put(corner(a, c, pair.scale_a) - origin, c, i, lanes.a);
      const Vec3d of_b = pair.b_in_a.rotation * corner(b, c, pair.scale_b);
      put(of_b + pair.b_in_a.translation - origin, c, i, lanes.b);
    }
    return origin;
  }

  static void put(Vec3d p, std::uint32_t corner, std::uint32_t i,
                  float (&rows)[9][kBatch]) noexcept {
    rows[3 * corner][i] = static_cast<float>(p.x);
    rows[3 * corner + 1][i] = static_cast<float>(p.y);
    rows[3 * corner + 2][i] = static_cast<float>(p.z);
  }

  void report_apart(const Active& item, Vec3d on_a, Vec3d apart) noexcept {
    const PairState& pair = pair_of(item);
    const Witness& witness = state_of(item).witness;
    const double distance = norm(apart);
    constexpr double kTouching = 1e-9;  // a direction of so short a vector is rounding
    const Vec3d normal = distance > kTouching ? (1 / distance) * apart : facing(pair, witness);
    add(item,
        {on_a, on_a - apart, normal, distance, pair.image_a->region_triangles[witness.a].piece,
         pair.image_b->region_triangles[witness.b].piece});
  }

  /// Where two triangles touch: the outward normal of b's.
  static Vec3d facing(const PairState& pair, const Witness& witness) noexcept {
    const RegionTriangle& t = pair.image_b->region_triangles[witness.b];
    const Vec3d p = corner(t, 0, 1);
    const Vec3d n = pair.b_in_a.rotation * cross(corner(t, 1, 1) - p, corner(t, 2, 1) - p);
    const double length = norm(n);
    return length > 0 ? (1 / length) * n : Vec3d{1, 0, 0};
  }

  void report_crossing(const Active& item) noexcept {
    const PairState& pair = pair_of(item);
    const PairFrame& frame = frame_of_item(item);
    const Witness& witness = state_of(item).witness;
    CrossingScratch& scratch = *memory_.crossing;
    scratch.list.count = 0;
    find_crossings(*memory_.kernels, frame, *memory_.search, pace_, item.region, scratch.list);
    // Only where the budget or rounding kept the search from finding any: the list shall not depend
    // on how the witness came about.
    if (scratch.list.count == 0) note_crossing(frame, witness.a, witness.b, scratch.list);
    if (scratch.list.count == kMaxCrossings) result_.iteration_cap_met = true;
    const Crossing c = deepest(pair, scratch);
    if (!c.exact) result_.iteration_cap_met = true;
    add(item, {c.point_a, c.point_b, c.normal, -c.depth, c.piece_a, c.piece_b});
  }

  /// In the coordinates of a, lengths in units.
  struct Found {
    Vec3d point_a;
    Vec3d point_b;
    Vec3d normal;
    double distance;
    std::uint32_t piece_a;
    std::uint32_t piece_b;
  };

  void add(const Active& item, const Found& found) noexcept {
    const PairState& pair = pair_of(item);
    if (result_.contacts == memory_.contacts.size()) {
      result_.truncated_by_memory = true;
      return;
    }
    Contact& out = memory_.contacts[result_.contacts++];
    out.point_a_m = pair.centre_a_m + pair.rotation_a * (pair.unit_m * found.point_a);
    out.point_b_m = pair.centre_a_m + pair.rotation_a * (pair.unit_m * found.point_b);
    out.normal = pair.rotation_a * found.normal;
    out.distance_m = found.distance * pair.unit_m;
    out.weight = 0;
    out.pair = item.pair;
    out.piece_a = found.piece_a;
    out.level_a = 0;
    out.piece_b = found.piece_b;
    out.level_b = 0;
    if (out.distance_m < result_.min_distance_m) result_.min_distance_m = out.distance_m;
  }

  QueryMemory& memory_;
  Demand demand_;
  Meter& meter_;
  Pace pace_;
  std::uint32_t count_ = 0;  // of active regions
  std::uint32_t pending_ = 0;
  std::uint32_t pending_of_[kBatch];  // which active region a pair to be measured belongs to
  bool truncated_ = false;
  QueryResult result_;
};

}  // namespace

QueryResult query(QueryMemory& memory, const Demand& demand, Meter& meter) noexcept {
  return Query(memory, demand, meter).run();
}

}  // namespace palpate::regions
