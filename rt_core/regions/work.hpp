// SPDX-License-Identifier: Apache-2.0
// What the stages of one query share: gather, narrow, certify, report.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "rt_core/regions/regions_engine.hpp"

namespace palpate::regions {

struct Work {
  static constexpr std::uint32_t kLeastRoom = 32;  ///< a corner near a corner
  /// Neighbours of a witness farther than this many delta are not looked at.
  static constexpr float kClimbReach = 2;

  Work(QueryMemory& query_memory, const Demand& query_demand, Meter& query_meter) noexcept
      : memory(query_memory),
        demand(query_demand),
        meter(query_meter),
        pace(query_meter),
        room(room_within(units_of_tick())) {}

  [[nodiscard]] std::span<Active> active() const noexcept { return memory.active.first(count); }
  [[nodiscard]] levels::PairState& pair_of(const Active& item) const noexcept {
    return memory.pairs[item.pair];
  }
  [[nodiscard]] const PairFrame& frame_of(const Active& item) const noexcept {
    return memory.frames[item.pair];
  }
  [[nodiscard]] RegionState& state_of(const Active& item) const noexcept {
    return memory.states[item.state];
  }
  [[nodiscard]] RegionPairs& kept_of(const Active& item) const noexcept {
    return memory.kept[item.state];
  }
  [[nodiscard]] Witness& witness_of(const Active& item) const noexcept {
    return memory.witnesses[item.state];
  }

  [[nodiscard]] float delta_of(const Active& item) const noexcept {
    return static_cast<float>(pair_of(item).delta);
  }
  /// min(witness, delta)
  [[nodiscard]] float upper_of(const Active& item) const noexcept {
    return is_felt(item) ? witness_of(item).distance : delta_of(item);
  }
  [[nodiscard]] bool is_felt(const Active& item) const noexcept {
    return witness_of(item).nearer_than(delta_of(item));
  }
  [[nodiscard]] bool is_crossing(const Active& item) const noexcept {
    return witness_of(item).crosses();
  }
  /// It has not climbed in this tick, and its witness is within two delta: worth it.
  [[nodiscard]] bool may_climb(const Active& item) const noexcept;
  /// In this tick, of what a search of it meets: it would not last.
  [[nodiscard]] bool keeps_nothing(const Active& item) const noexcept {
    return !demand.limited && state_of(item).bare_searches > 0;
  }
  /// Not thinned out (crowd.hpp).
  [[nodiscard]] bool is_present(const Active& item) const noexcept {
    return memory.crowd.has(item.state);
  }
  /// It is felt, and not thinned out.
  [[nodiscard]] bool is_contact(const Active& item) const noexcept {
    return is_felt(item) && is_present(item);
  }
  /// Whether nothing of two bodies is felt, but it is not proved that nothing is there. O(active)
  [[nodiscard]] bool may_touch_unfelt(std::uint32_t pair) const noexcept;
  [[nodiscard]] double width_m(const Active& item) const noexcept {
    return static_cast<double>(item.width) * pair_of(item).unit_m;
  }

  /// Which active region a state is of, kNone where none is. O(log count)
  [[nodiscard]] std::uint32_t active_of(std::uint32_t state) const noexcept;

  /// What one takes, about.
  [[nodiscard]] std::uint64_t unit_ns() const noexcept {
    constexpr std::uint64_t kAssumed_ns = 70;  // until ticks have told
    return memory.pursuit.unit_ns > 0 ? memory.pursuit.unit_ns : kAssumed_ns;
  }
  /// Work units that the whole tick does for, about; infinity where nothing limits it.
  [[nodiscard]] double units_of_tick() const noexcept { return meter.queries_in_all(unit_ns()); }
  /// The same of what is left, with what is granted however late it is.
  [[nodiscard]] double units_left() const noexcept { return units_left(unit_ns()); }
  /// Of units that take so long each.
  [[nodiscard]] double units_left(std::uint64_t each_ns) const noexcept {
    const double in_time = meter.queries_affordable(each_ns);
    const auto granted = static_cast<double>(pace.granted());
    const double units = meter.queries_affordable(0);
    const double most = in_time > granted ? in_time : granted;
    return most < units ? most : units;
  }

  /// What is kept is measured in the ticks to come, and what is not ends a search sooner: of a
  /// region no more than a tick of so many units does for.
  static std::uint32_t room_within(double units) noexcept {
    constexpr double kUnitsForEach = 16;
    const double room = units / kUnitsForEach;
    if (room < kLeastRoom) return kLeastRoom;
    return room < kNearPairs ? static_cast<std::uint32_t>(room) : kNearPairs;
  }

  /// Until pace.no_limit(), of what the tick has left no more than this share.
  void limit_to(double share) noexcept {
    constexpr double kEndless = 1e18;
    const double units = share * units_left();
    if (units < kEndless) pace.limit(static_cast<std::uint64_t>(units));
  }

  /// Time for all contacts, and units for the pairs of triangles that cross (report.hpp).
  void leave_for_report(std::uint64_t felt, std::uint64_t crossing) noexcept;

  /// A region whose bounds have changed: sets its width and urgency.
  void widen(Active& item) noexcept;
  void widen_all() noexcept;
  /// A region whose share of a tolerance is larger is searched less often. While intervals grow
  /// alike, all searches together are cheapest with shares in proportion to the root of what a
  /// search costs: least sum of cost / share for a given sum of shares. Without a tolerance the
  /// shares order what is left to prove (worth()).
  void weigh_all() noexcept;
  /// Of an interval in the order of a tick: its width, with a tolerance or where it is narrow over
  /// what a search of it costs.
  [[nodiscard]] float worth(const Active& item) const noexcept;
  /// What a region that is felt weighs in the force (force/penalty.hpp), in squares of delta, and
  /// with what it may still gain.
  [[nodiscard]] float mass_of(const Active& item) const noexcept;
  /// By what to multiply that under a budget after a jump, and while nothing is felt.
  [[nodiscard]] float weight_of_unknown(const Active& item) const noexcept;

  QueryMemory& memory;
  Demand demand;
  Meter& meter;
  Pace pace;
  std::uint32_t room;          ///< pairs that are kept of a region, at most
  std::uint32_t count = 0;     ///< of active regions
  std::uint32_t searches = 0;  ///< of whole regions, completed
  bool swept = false;          ///< nothing was known when the tick began (sweep.hpp)
  bool anew = false;           ///< nothing, or what many contacts of a place that is left behind
                               ///< tell: searches and surveys as after a jump
  bool touching = true;        ///< something is felt as the tick begins
  bool followed = false;       ///< searches did not keep up (follow.hpp)
  bool truncated = false;      ///< the budget ended refinement
  QueryResult result{.min_distance_m = std::numeric_limits<double>::infinity(),
                     .unresolved_lower_m = std::numeric_limits<double>::infinity()};
};

/// Of active regions, the one whose witness is nearest first.
struct NearerWitness {
  const Work& work;
  bool operator()(std::uint32_t a, std::uint32_t b) const noexcept {
    const float of_a = work.witness_of(work.active()[a]).distance;
    const float of_b = work.witness_of(work.active()[b]).distance;
    return of_a < of_b || (of_a == of_b && a < b);
  }
};

}  // namespace palpate::regions
