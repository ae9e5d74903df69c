// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/contact_search.hpp"

#include "rt_core/base/queue.hpp"
#include "rt_core/contact/facing.hpp"
#include "rt_core/force/constraints.hpp"
#include "rt_core/regions/measure.hpp"

namespace palpate::regions {
namespace {

/// Rounds of measuring and solving, at most.
constexpr std::uint32_t kMostRounds = 64;
/// Of the regions that are open, one in so many is measured before the push is solved again; at
/// least kLeastAtOnce.
constexpr std::uint32_t kPartAtOnce = 4;
constexpr std::uint32_t kLeastAtOnce = 4;
/// Of a region so many vertices and edges are measured before others have their turn; twice as many
/// after each so many rounds.
constexpr std::uint32_t kFewPerVisit = 4;
constexpr std::uint32_t kRoundsToDouble = 4;
/// A contact counts in the torque where it is stronger than half of the push (force/wrench.hpp).
constexpr double kTorqueShare = 0.5;
/// Work units: regions that are looked through, and contacts that a push is solved for.
constexpr std::uint32_t kCollectedPerUnit = 4;
constexpr std::uint32_t kSolvedPerUnit = 8;

/// Vertices that are measured because they are likely to change the push, at most.
constexpr std::uint32_t kMostGuesses = 64;
/// Vertices that are looked at before some are measured, and how many then.
constexpr std::uint32_t kLooksAtOnce = 256;
constexpr std::uint32_t kFewGuesses = 2;
/// Likely contacts that exceed the push by less, in delta, are not worth it.
constexpr double kLikelyExcess = 0.01;
/// Work units: vertices that are looked at, and likely contacts that are compared with the push.
constexpr std::uint32_t kLookedPerUnit = 8;
constexpr std::uint32_t kScannedPerUnit = 64;

struct HigherPriority {
  std::span<const NearRegion> near;
  bool operator()(std::uint32_t a, std::uint32_t b) const noexcept {
    return near[a].priority > near[b].priority || (near[a].priority == near[b].priority && a < b);
  }
};

}  // namespace

ContactSearch::ContactSearch(ContactMemory& memory, double delta_m) noexcept
    : memory_(memory), measure_(memory, pace_, explanation_, out_) {
  explanation_.delta_m = delta_m;
  ++memory_.tick;
}

void ContactSearch::guess(Pace& pace) noexcept {
  pace_ = &pace;
  gather();
  for (std::uint32_t i = 0; i < memory_.warm.count && pace.go_on(); ++i) {
    measure_.source(memory_.warm.sources[i]);
  }
  look_and_measure();
  out_.guessed = pace.go_on();
}

void ContactSearch::prove(Pace& pace) noexcept {
  pace_ = &pace;
  // Vertices tell most for their time; then edges, and what counts in the torque alone.
  force_proved_ = explain(1, false) && explain(1, true);
  out_.proved = force_proved_ && explain(kTorqueShare, true) && !out_.contacts_full;
}

/// Regions that may be within reach.
void ContactSearch::gather() noexcept {
  for (std::uint32_t side = 0; side < memory_.sides.size(); ++side) {
    const std::uint32_t pair = side / 2;
    const SideView& view = memory_.views[side] =
        view_of(memory_.pairs[pair], pair, memory_.bodies[pair], memory_.tool, side % 2 == 0,
                *memory_.kernels);
    if (!view.pushes_tool) continue;
    // The bodies as they were before detail was left out may be nearer.
    const double with_detail = view.delta + memory_.pairs[pair].deviation;
    const double reach =
        contact::kReach * view.delta > with_detail ? contact::kReach * view.delta : with_detail;
    const double deepest = -view.side.target.surface.scale;  // nothing is deeper than the radius
    const std::span<const RegionBound> bounds = memory_.sides[side].regions;
    for (std::uint32_t region = 0; region < bounds.size(); ++region) {
      const double lower = bounds[region].lower_until - view.odometer;
      if (lower > reach) continue;
      memory_.near[near_++] = {lower > deepest ? lower : deepest, 0, side, region, 0};
    }
  }
}

/// Measures the vertices that are likely to change the push most, until none is. What is likely
/// is looked up in parts, so that some of it is measured however early time ends; the next tick
/// goes on with the regions that are left.
void ContactSearch::look_and_measure() noexcept {
  std::uint32_t looked = 0;
  while (looked < near_ && pace_->go_on()) {
    std::uint32_t of_part = 0;
    for (; looked < near_ && of_part < kLooksAtOnce && pace_->go_on(); ++looked) {
      const NearRegion& item = memory_.near[(memory_.next_look + looked) % near_];
      LikelyContacts likely(memory_.views[item.side], item.side, memory_.sides[item.side].likely,
                            memory_.push);
      of_part += likely.look(item.region, memory_.likely, out_.likely);
    }
    pace_->charge(of_part / kLookedPerUnit);
    measure_likely(looked < near_ ? kFewGuesses : kMostGuesses);
  }
  memory_.next_look = near_ > 0 ? (memory_.next_look + looked) % near_ : 0;
}

void ContactSearch::measure_likely(std::uint32_t most) noexcept {
  for (const LikelyContact& c : memory_.likely.first(out_.likely)) {
    const double strength_m = static_cast<double>(c.strength_m);
    likely_strongest_m_ = strength_m > likely_strongest_m_ ? strength_m : likely_strongest_m_;
  }
  for (std::uint32_t round = 0; round < most && pace_->go_on(); ++round) {
    solve();
    const LikelyContact* const next = most_violated();
    if (next == nullptr) return;
    measure_.source({next->side, next->vertex});
  }
  solve();
}

/// Of likely contacts that are not measured, that which exceeds the push most; null: none does.
const LikelyContact* ContactSearch::most_violated() noexcept {
  const force::Push& push = out_.push.push;
  const LikelyContact* out = nullptr;
  double most = kLikelyExcess * explanation_.delta_m;
  for (const LikelyContact& c : memory_.likely.first(out_.likely)) {
    const double faded =
        (1 - static_cast<double>(c.weight)) * force::kFadedShare * likely_strongest_m_;
    const double excess =
        static_cast<double>(c.strength_m) - faded - push.along(vec_cast<double>(c.push));
    if (excess <= most || memory_.sides[c.side].vertices[c.vertex].measured_tick == memory_.tick) {
      continue;
    }
    most = excess;
    out = &c;
  }
  pace_->charge(out_.likely / kScannedPerUnit);
  return out;
}

/// Measures what a share of the push does not explain, until nothing is left.
/// @return false where the budget or the rounds have ended it
bool ContactSearch::explain(double share, bool edges) noexcept {
  explanation_.share = share;
  explanation_.edges = edges;
  ++explanation_.version;
  for (std::uint32_t round = 0; round < kMostRounds; ++round) {
    solve();
    const std::uint32_t open = collect_open();
    if (open == 0) out_.excess_m = out_.stronger_m = 0;
    if (open == 0) return true;
    MinQueue<std::uint32_t, HigherPriority> queue(memory_.queue.first(open),
                                                  HigherPriority{memory_.near});
    queue.fill();
    const std::uint32_t part = open / kPartAtOnce;
    const std::uint32_t at_once = part > kLeastAtOnce ? part : kLeastAtOnce;
    for (std::uint32_t i = 0; i < at_once && !queue.empty(); ++i) {
      if (!pace_->go_on()) {
        solve();
        return false;
      }
      measure_.region(memory_.near[queue.top()], kFewPerVisit << (round / kRoundsToDouble));
      queue.pop();
    }
  }
  solve();
  return collect_open() == 0;
}

/// By how much a region may change the push; what is settled may not.
double ContactSearch::excess_m(const NearRegion& item) const noexcept {
  if (item.lower >= kUnknown || item.settled == explanation_.version) return -kUnknown;
  const SideView& view = memory_.views[item.side];
  return explanation_.excess_m(view, explanation_.explained_m(view, item.region), item.lower);
}

std::uint32_t ContactSearch::collect_open() noexcept {
  pace_->charge(near_ / kCollectedPerUnit);
  std::uint32_t open = 0;
  for (std::uint32_t i = 0; i < near_; ++i) {
    NearRegion& item = memory_.near[i];
    item.priority = excess_m(item);
    if (!explanation_.is_open(item.priority)) continue;
    if (measure_.is_stale(item)) {
      const SideView& view = memory_.views[item.side];
      item.priority = explanation_.excess_m(view, 0, measure_.likely_distance(item));
    }
    memory_.queue[open++] = i;
  }
  return open;
}

void ContactSearch::solve() noexcept {
  const std::span<force::PushConstraint> constraints = memory_.constraints.first(out_.contacts);
  out_.strongest_m = force::set_constraints(memory_.contacts.first(out_.contacts), memory_.bodies,
                                            memory_.tool, explanation_.delta_m, constraints);
  std::uint32_t start[force::kMostCarrying];
  for (std::uint32_t i = 0; i < out_.push.carrying_count; ++i) {
    start[i] = out_.push.carrying[i].index;
  }
  out_.push = force::least_push(constraints, {start, out_.push.carrying_count});
  pace_->charge(out_.contacts / kSolvedPerUnit);
  const force::Push& push = out_.push.push;
  const bool same = push.vector == explanation_.push.vector &&
                    push.squeeze_diagonal == explanation_.push.squeeze_diagonal &&
                    push.squeeze_mixed == explanation_.push.squeeze_mixed &&
                    out_.strongest_m == explanation_.strongest_m;
  if (!same) ++explanation_.version;
  explanation_.push = push;
  explanation_.strongest_m = out_.strongest_m;
}

/// By how much what is not measured may change the push.
void ContactSearch::bound_error() noexcept {
  out_.excess_m = out_.stronger_m = 0;
  for (std::uint32_t i = 0; i < near_; ++i) {
    const NearRegion& item = memory_.near[i];
    const double excess = excess_m(item);
    if (!explanation_.is_open(excess)) continue;
    const double stronger = explanation_.stronger_m(item.lower * memory_.views[item.side].unit_m);
    if (stronger > out_.stronger_m) out_.stronger_m = stronger;
    if (excess > out_.excess_m) out_.excess_m = excess;
  }
}

/// What is left open, and what carries.
const ContactSearchResult& ContactSearch::conclude() noexcept {
  if (!force_proved_) bound_error();
  memory_.push.changed_m += 2 * norm(out_.push.push.vector - memory_.push.push.vector);
  memory_.push.push = out_.push.push;
  memory_.warm.count = out_.push.carrying_count;
  for (std::uint32_t i = 0; i < out_.push.carrying_count; ++i) {
    memory_.warm.sources[i] = memory_.sources[out_.push.carrying[i].index];
  }
  return out_;
}

double push_error_m(const ContactSearchResult& found) noexcept {
  return force::push_error(found.push.push, found.excess_m) +
         force::push_error(found.push.push, 0.5 * found.stronger_m);
}

}  // namespace palpate::regions
