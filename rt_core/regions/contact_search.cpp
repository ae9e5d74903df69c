// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/contact_search.hpp"

#include "rt_core/base/queue.hpp"
#include "rt_core/contact/facing.hpp"
#include "rt_core/contact/nearby.hpp"
#include "rt_core/force/constraints.hpp"
#include "rt_core/force/wrench.hpp"
#include "rt_core/regions/measure.hpp"

namespace palpate::regions {
namespace {

/// Rounds of measuring and solving, at most.
constexpr std::uint32_t kMostRounds = 64;
/// Work units: regions that are compared with the push, and contacts that one is solved for.
constexpr std::uint32_t kComparedPerUnit = 4;
constexpr std::uint32_t kSolvedPerUnit = 8;

/// Vertices that are measured because they are likely to change the push, at most.
constexpr std::uint32_t kMostGuesses = 64;
/// Vertices that are looked at before some are measured, and how many then.
constexpr std::uint32_t kLooksAtOnce = 128;
constexpr std::uint32_t kFewGuesses = 2;
/// Likely contacts that exceed the push by less, in delta, are not worth it.
constexpr double kLikelyExcess = 0.01;
/// Work units: vertices and regions that are looked at, and likely contacts that are compared with
/// the push.
constexpr std::uint32_t kLookedPerUnit = 8;
constexpr std::uint32_t kScannedPerUnit = 64;

struct HigherPriority {
  std::span<const NearRegion> near;
  bool operator()(std::uint32_t a, std::uint32_t b) const noexcept {
    return near[a].priority > near[b].priority || (near[a].priority == near[b].priority && a < b);
  }
};

}  // namespace

ContactSearch::ContactSearch(ContactMemory& memory, const PushDemand& demand) noexcept
    : memory_(memory), demand_(demand), measure_(memory, pace_, explanation_, out_) {
  explanation_.delta_m = demand.delta_m;
  ++memory_.tick;
  gather();
}

void ContactSearch::guess(Pace& pace) noexcept {
  pace_ = &pace;
  for (std::uint32_t i = 0; i < memory_.warm.count && may_measure(); ++i) {
    measure(memory_.warm.sources[i]);
  }
  look_and_measure();
}

void ContactSearch::prove_push(Pace& pace) noexcept {
  pace_ = &pace;
  // Vertices first: they change the push most for their time, should the budget end the search.
  out_.push_proved = explain(1, false) && explain(1, true) && !out_.contacts_full;
}

void ContactSearch::see_minima(Pace& pace, std::span<const Contact> minima,
                               std::span<const std::uint32_t> edges) noexcept {
  pace_ = &pace;
  for (std::size_t i = 0; i < minima.size() && out_.likely < memory_.likely.size(); ++i) {
    const Contact& c = minima[i];
    const std::uint32_t side = 2 * c.pair;
    const SideView& view = memory_.views[side];
    const bool counts = edges[i] != image::kNone && view.pushes_tool && c.distance_m > 0;
    if (!counts) continue;
    const Vec3d push = view.points_of_tool ? c.normal : -c.normal;
    memory_.likely[out_.likely++] = {vec_cast<float>(push),
                                     static_cast<float>(demand_.delta_m - c.distance_m),
                                     1,
                                     {side, edges[i] | ContactSource::kEdge}};
  }
  measure_likely(kMostGuesses);
}

bool ContactSearch::see_components(Pace& pace) noexcept {
  pace_ = &pace;
  bool outside = true;
  for (std::uint32_t side = 0; side < memory_.sides.size(); ++side) {
    const SideView& view = memory_.views[side];
    const ImageView& points = view.image();
    std::uint32_t first = 0;  // triangle of a component
    do {
      const std::uint32_t vertex = points.triangle_vertices[first].corner[0];
      pace_->charge(1);
      const Vec3d x = view.side.to_target(contact::position(view.side.points, vertex));
      double lower = contact::distance_bound(view.side.target.surface, x);
      if (!(lower > 0) && pace_->go_on()) {
        measure({side, vertex});
        lower = memory_.sides[side].vertices[vertex].lower_until - view.odometer;
      }
      outside = outside && lower > 0;
      first = points.region_triangles[first].component;
    } while (first != 0 && first != image::kNone);
  }
  return outside;
}

void ContactSearch::prove_places(Pace& pace) noexcept {
  pace_ = &pace;
  out_.places_proved = out_.push_proved && explain(force::kTakesPart, true) && !out_.contacts_full;
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

LikelyContacts ContactSearch::likely_contacts(std::uint32_t side) noexcept {
  return {memory_.views[side], side, memory_.sides[side].likely, memory_.push};
}

/// Measures the vertices that are likely to change the push most, until none is. Regions are looked
/// at in the order of what they promise, and some vertices are measured after each part of them,
/// however early time ends.
void ContactSearch::look_and_measure() noexcept {
  MinQueue<std::uint32_t, HigherPriority> due(memory_.queue.first(collect_due()),
                                              HigherPriority{memory_.near});
  due.fill();
  // A look takes less than a unit: the clock is read for each region.
  while (!due.empty() && pace_->go_on_for(0)) {
    for (std::uint32_t of_part = 0; of_part < kLooksAtOnce && !due.empty() && pace_->go_on_for(0);
         due.pop()) {
      NearRegion& item = memory_.near[due.top()];
      item.lower = raised_by_grid(item);
      const std::uint32_t looks =
          1 + likely_contacts(item.side).look(item.region, memory_.likely, out_.likely);
      of_part += looks;
      pace_->charge((looks + kLookedPerUnit - 1) / kLookedPerUnit);
    }
    measure_likely(due.empty() ? kMostGuesses : kFewGuesses);
  }
}

/// Regions that are due to be looked at, and what they promise.
std::uint32_t ContactSearch::collect_due() noexcept {
  std::uint32_t due = 0;
  std::uint32_t bounded = 0;
  for (std::uint32_t i = 0; i < near_; ++i) {
    NearRegion& item = memory_.near[i];
    LikelyContacts likely = likely_contacts(item.side);
    if (memory_.sides[item.side].likely.regions[item.region].never_looked()) {
      if (!pace_->go_on_for(0)) continue;
      item.lower = raised_by_grid(item);
      likely.promise_by_distance(item.region, item.lower,
                                 sphere_of(memory_.views[item.side], item.region).radius);
      if (++bounded % kLookedPerUnit == 0) pace_->charge(1);
    }
    if (!likely.is_due(item.region)) continue;
    item.priority = likely.promise(item.region);
    memory_.queue[due++] = i;
  }
  return due;
}

/// What is known of a region's distance, with what the other body's grid tells at its centre.
double ContactSearch::raised_by_grid(const NearRegion& item) noexcept {
  const SideView& view = memory_.views[item.side];
  const Sphere sphere = sphere_of(view, item.region);
  const double bound =
      contact::distance_bound(view.side.target.surface, view.side.to_target(sphere.centre)) -
      sphere.radius;
  if (bound <= item.lower) return item.lower;
  memory_.sides[item.side].regions[item.region].lower_until = bound + view.odometer;
  return bound;
}

void ContactSearch::measure_likely(std::uint32_t most) noexcept {
  for (const LikelyContact& c : memory_.likely.first(out_.likely)) {
    const double strength_m = static_cast<double>(c.strength_m);
    likely_strongest_m_ = strength_m > likely_strongest_m_ ? strength_m : likely_strongest_m_;
  }
  for (std::uint32_t round = 0; round < most && may_measure(); ++round) {
    solve();
    const LikelyContact* const next = most_violated();
    if (next == nullptr) return;
    measure(next->source);
  }
  solve();
}

bool ContactSearch::may_measure() noexcept { return pace_->go_on_for(memory_.measure_ns); }

/// One vertex or edge, however long it takes.
void ContactSearch::measure(const ContactSource& source) noexcept {
  const std::uint64_t begun_ns = pace_->elapsed_ns();
  measure_.source(source);
  follow(memory_.measure_ns, pace_->elapsed_ns() - begun_ns);
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
    if (excess <= most || memory_.is_measured(c.source)) continue;
    most = excess;
    out = &c;
  }
  pace_->charge(out_.likely / kScannedPerUnit);
  return out;
}

/// Measures all that a share of the push does not explain, solves, and again, until nothing is
/// left.
/// @param edges  or vertices alone
/// @return false where the budget or the rounds have ended it
bool ContactSearch::explain(double share, bool edges) noexcept {
  explanation_.share = share;
  explanation_.edges = edges;
  ++explanation_.version;
  bool open = true;
  for (std::uint32_t round = 0; round < kMostRounds && open && pace_->go_on(); ++round) {
    solve();
    open = false;
    for (std::uint32_t i = 0; i < near_ && pace_->go_on(); ++i) {
      if (i % kComparedPerUnit == 0) pace_->charge(1);
      NearRegion& item = memory_.near[i];
      if (!explanation_.is_open(excess_m(item))) continue;
      open = true;
      measure_.region(item);
    }
  }
  solve();
  return !open && pace_->go_on();
}

/// By how much a region may change the push; what is settled may not.
double ContactSearch::excess_m(const NearRegion& item) const noexcept {
  if (item.lower >= kUnknown || item.settled == explanation_.version) return -kUnknown;
  const SideView& view = memory_.views[item.side];
  return explanation_.excess_m(view, explanation_.explained_m(view, item.region), item.lower);
}

void ContactSearch::solve() noexcept {
  if (solved_ == out_.contacts) return;
  solved_ = out_.contacts;
  pace_->expect_contacts(out_.contacts + out_.likely);
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
  explanation_.negligible_m = force::tolerated_violation(push, 0.5 * demand_.tolerance_m);
  const bool same = push.vector == explanation_.push.vector &&
                    push.squeeze_diagonal == explanation_.push.squeeze_diagonal &&
                    push.squeeze_mixed == explanation_.push.squeeze_mixed &&
                    out_.strongest_m == explanation_.strongest_m;
  if (!same) ++explanation_.version;
  explanation_.push = push;
  explanation_.strongest_m = out_.strongest_m;
}

/// By how much what is not measured may change the push. Where the proof has not come to its end,
/// by what the nearest may be against all directions.
void ContactSearch::bound_error() noexcept {
  const double lower_m = out_.lower_m = least_lower_m();
  double excess_m = 0;
  double stronger_m = 0;
  if (out_.push_proved) {
    excess_m = stronger_m = explanation_.negligible_m;
  } else if (lower_m < contact::kReach * explanation_.delta_m) {
    const double strength_m = explanation_.strength_of_distance(lower_m);
    excess_m = strength_m + norm(out_.push.push.vector);
    stronger_m = strength_m > out_.strongest_m ? strength_m - out_.strongest_m : 0;
  }
  // Those that are missing, and those that fade more the stronger the strongest is.
  out_.error_m = force::push_error(out_.push.push, excess_m) +
                 force::push_error(out_.push.push, force::kFadedShare * stronger_m);
}

/// Of what has not been measured.
double ContactSearch::least_lower_m() const noexcept {
  double lower_m = kUnknown;
  for (const NearRegion& item : memory_.near.first(near_)) {
    const double unmeasured_m = item.lower * memory_.views[item.side].unit_m;
    lower_m = unmeasured_m < lower_m ? unmeasured_m : lower_m;
  }
  return lower_m;
}

/// What is left open, and what carries.
const ContactSearchResult& ContactSearch::conclude() noexcept {
  bound_error();
  memory_.push.changed_m += force::difference(out_.push.push, memory_.push.push);
  memory_.push.push = out_.push.push;
  memory_.warm.count = out_.push.carrying_count;
  for (std::uint32_t i = 0; i < out_.push.carrying_count; ++i) {
    memory_.warm.sources[i] = memory_.sources[out_.push.carrying[i].index];
  }
  return out_;
}

}  // namespace palpate::regions
