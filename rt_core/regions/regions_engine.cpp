// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/regions_engine.hpp"

#include <limits>

#include "rt_core/base/queue.hpp"

namespace palpate::regions {
namespace {

using image::RegionTriangle;
using levels::PairState;

/// Distances up to delta and this many ticks of the present motion are told apart, so that a region
/// that is found farther rests for as long; not where that is more than a share of delta, for a
/// farther limit costs more than the rest saves.
constexpr double kRestTicks = 4;
constexpr double kMostRest = 0.5;
/// A move by more than this (in units), or by this many delta where that is more, starts anew.
constexpr double kJump = 0.05;
constexpr double kJumpDelta = 2;
/// Rounding of the odometers, in units.
constexpr double kMotionSlack = 1e-9;
/// Under a budget an interval is closed to this share of its width at a time.
constexpr float kStep = 0.1f;
/// Below this an interval is closed: rounding leaves as much.
constexpr float kClosed = 2 * kRounding;

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
    climb_witnesses();
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
    sweep(*memory_.kernels, memory_.frames[index], *memory_.search, pace_, limit_of(pair), swept);
    for (std::uint32_t i = 0; i < swept.size(); ++i) {
      RegionState& state = memory_.states[memory_.first_state[index] + i];
      const double lower = static_cast<double>(sqrt_of(swept[i].squared) - kRounding);
      state.seed = swept[i].seed;
      if (lower > lower_now(pair, index, i)) prove(pair, state, lower);
    }
  }

  double lower_now(const PairState& pair, std::uint32_t index, std::uint32_t region) noexcept {
    const RegionState& state = memory_.states[memory_.first_state[index] + region];
    const double reach = pair.scale_a * static_cast<double>(pair.image_a->regions[region].reach);
    return static_cast<double>(state.lower) - (pair.travel - state.travel_at) -
           (pair.turn - state.turn_at) * reach - kMotionSlack;
  }

  static void prove(const PairState& pair, RegionState& state, double lower) noexcept {
    state.lower = float_below(lower);
    state.travel_at = pair.travel;
    state.turn_at = pair.turn;
  }

  /// Distances up to here are told apart.
  static float limit_of(const PairState& pair) noexcept {
    const double rest = kRestTicks * (pair.last_travel + pair.last_turn * pair.scale_a);
    return static_cast<float>(rest <= kMostRest * pair.delta ? pair.delta + rest : pair.delta) +
           kClosed;
  }

  /// The regions of a pair that may be nearer than delta.
  void gather(std::uint32_t index) noexcept {
    const PairState& pair = memory_.pairs[index];
    memory_.frames[index] = frame_of(pair);
    sweep_if_lost(index);
    const std::uint32_t first = memory_.first_state[index];
    const auto regions = pair.image_a->regions;
    for (std::uint32_t i = 0; i < regions.size(); ++i) {
      const double lower = lower_now(pair, index, i);
      if (lower >= pair.delta) continue;
      Active& item = memory_.active[count_++];
      item.lower = lower > 0 ? float_below(lower) : 0.0f;
      item.state = first + i;
      item.region = i;
      item.pair = index;
    }
  }

  void measure_witnesses() noexcept {
    Witness* batch[kBatch];
    std::uint32_t pending = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const Active& item = active()[i];
      Witness& witness = state_of(item).witness;
      if (witness.known()) batch[pending++] = &witness;
      const bool last_of_pair = i + 1 == count_ || active()[i + 1].pair != item.pair;
      if (pending > 0 && (pending == kBatch || last_of_pair)) {
        measure(*memory_.kernels, frame_of_item(item), *memory_.search, pace_, batch, pending);
        pending = 0;
      }
    }
    for (Active& item : active()) widen(item);
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
    item.width = upper > item.lower ? upper - item.lower : 0;
  }

  void refine() noexcept {
    if (demand_.limited || demand_.tolerance_m > 0) {
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
    // The search's lower bound gives away kRounding, which is part of the interval.
    const float room = tolerance > kRounding ? tolerance - kRounding : 0;
    const Bounds found = search(*memory_.kernels, frame_of_item(item), *memory_.search, pace_,
                                item.region, state.witness, limit_of(pair), room);
    state.witness = found.best;
    if (found.lower > item.lower) item.lower = found.lower;
    truncated_ |= !found.complete;
    prove(pair, state, static_cast<double>(item.lower));
    widen(item);
  }

  void certify() noexcept {
    for (const Active& item : active()) {
      const PairState& pair = pair_of(item);
      const double lower_m = static_cast<double>(item.lower) * pair.unit_m;
      if (static_cast<double>(item.lower) < pair.delta && lower_m < result_.unresolved_lower_m) {
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
  bool truncated_ = false;
  QueryResult result_;
};

}  // namespace

QueryResult query(QueryMemory& memory, const Demand& demand, Meter& meter) noexcept {
  return Query(memory, demand, meter).run();
}

}  // namespace palpate::regions
