// SPDX-License-Identifier: Apache-2.0
// The tick: poses, query, force, certificate.
#include "rt_core/engine.hpp"

#include <limits>

#include "rt_core/base/meter.hpp"
#include "rt_core/contact/facing.hpp"
#include "rt_core/force/constraints.hpp"
#include "rt_core/force/wrench.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate {
namespace {

constexpr double kUnitQuaternion = 1e-3;
/// Units that proving a push may take where no proof is asked for.
constexpr std::uint64_t kCheapProof = 500;
constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
/// What rounding of float vertices, transforms and queries leaves of a distance, in units of the
/// larger radius.
constexpr double kNumericalError = 5e-7;

bool finite(double v) noexcept { return v - v == 0; }
bool finite(Vec3d v) noexcept { return finite(v.x) && finite(v.y) && finite(v.z); }

bool normalise(const Pose& in, Pose& out) noexcept {
  const Quat& q = in.orientation;
  const double length = sqrt_of(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!finite(in.position_m) || !(length >= 1 - kUnitQuaternion && length <= 1 + kUnitQuaternion))
    return false;
  out.position_m = in.position_m;
  out.orientation = {q.w / length, q.x / length, q.y / length, q.z / length};
  return true;
}

levels::Rules rules_of(const Settings& settings) noexcept {
  return {.exact = settings.exact,
          .bounds = settings.bounds,
          .order = settings.order,
          .s0 = settings.s0,
          .kappa = settings.kappa};
}

double largest_unit_m(std::span<const levels::PairState> pairs) noexcept {
  double unit = 0;
  for (const levels::PairState& pair : pairs) unit = pair.unit_m > unit ? pair.unit_m : unit;
  return unit;
}

/// What no query can know: numbers are rounded, and a baked surface may be coarser than its mesh.
double least_error_m(std::span<const levels::PairState> pairs) noexcept {
  double deviation_m = 0;
  for (const levels::PairState& pair : pairs) {
    const double of_pair_m = pair.deviation * pair.unit_m;
    deviation_m = of_pair_m > deviation_m ? of_pair_m : deviation_m;
  }
  return deviation_m + kNumericalError * largest_unit_m(pairs);
}

/// Whether there is a contact below delta.
/// @param lower_m  bound of the distance of what has not been measured
ContactStatus contact_status(bool found, double lower_m, double delta_m) noexcept {
  if (found) return ContactStatus::found;
  return lower_m < delta_m ? ContactStatus::undecided : ContactStatus::ruled_out;
}

/// What a query says of its answer, whichever engine found it.
struct Found {
  std::uint32_t contacts = 0;
  std::uint32_t clusters = 0;
  std::uint64_t tail_contacts = 0;  ///< how many take as long
  double min_distance_m = 0;
  std::uint64_t front_nodes = 0;
  std::uint64_t queries = 0;
  Certificate certificate;
};

Certificate certify_levels(const Engine& engine, const levels::QueryResult& found) noexcept {
  const double delta_m = engine.settings.delta_m;
  Certificate c;
  const double lower_m = found.capped_gap_m > 0 ? 0 : found.unresolved_lower_m;
  c.contact = contact_status(found.contacts > 0, lower_m, delta_m);
  const double nearest =
      found.contacts > 0 && found.min_distance_m < delta_m ? found.min_distance_m : delta_m;
  const double below = found.unresolved_lower_m < nearest ? nearest - found.unresolved_lower_m : 0;
  const double above = found.contacts > 0 && found.upper_m > nearest ? found.upper_m - nearest : 0;
  c.error_bound_m =
      (below > above ? below : above) + found.capped_gap_m + least_error_m(engine.states);
  c.s_worst = found.s_worst;
  c.truncated_by_time = found.truncated_by_time;
  c.truncated_by_units = found.truncated_by_units;
  c.truncated_by_memory = found.truncated_by_memory;
  c.iteration_cap_met = found.iteration_cap_met;
  return c;
}

/// So much of a budget, from now on.
Budget part_of(const Budget& budget, std::uint64_t numerator, std::uint64_t denominator) noexcept {
  Budget out = budget;
  out.reserve_units = out.reserve_ns = 0;
  if (out.units != kUnlimited) out.units = out.units / denominator * numerator;
  if (out.clock_ns == nullptr || out.deadline_ns == kUnlimited) return out;
  const std::uint64_t now = out.clock_ns(out.clock_context);
  const std::uint64_t left = out.deadline_ns > now ? out.deadline_ns - now : 0;
  out.deadline_ns = now + left / denominator * numerator;
  return out;
}

/// What is left of a budget of which so many units have been used.
Budget left_of(Budget budget, std::uint64_t used) noexcept {
  if (budget.units != kUnlimited) budget.units -= used < budget.units ? used : budget.units;
  return budget;
}

/// Where a search has not proved where the push acts, contacts that are likely tell it beside those
/// measured: all of them, or every second or third and so on where time would not do.
/// @return how many constraints and points there are then
std::size_t add_likely_places(Engine& engine, const regions::ContactSearchResult& found,
                              const Meter& meter) noexcept {
  const regions::ContactMemory& search = engine.search;
  const double affordable = meter.contacts_affordable() - found.contacts;
  std::uint32_t stride = 1;
  while (stride < found.likely && affordable * stride < found.likely) ++stride;
  std::size_t count = found.contacts;
  for (std::uint32_t i = 0; i < found.likely; i += stride) {
    const regions::LikelyContact& c = search.likely[i];
    if (count == engine.push_points.size()) break;
    if (c.source.is_edge() || search.is_measured(c.source)) continue;
    const Vec3d normal = vec_cast<double>(c.push);
    const double strength_m = static_cast<double>(c.strength_m);
    if (strength_m <= force::kTakesPart * found.push.push.along(normal)) continue;
    const regions::SideView& view = search.views[c.source.side];
    const Vec3d point = view.side.to_target(contact::position(view.side.points, c.source.item));
    search.constraints[count] = {normal, strength_m};
    engine.push_points[count].arm_m = view.world(point) - engine.poses[engine.tool].position_m;
    ++count;
  }
  return count;
}

force::PushWrench wrench_of(Engine& engine, const regions::ContactSearchResult& found,
                            const Meter& meter) noexcept {
  const Pose& tool = engine.poses[engine.tool];
  const std::span<const Contact> contacts = engine.search.contacts.first(found.contacts);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    engine.push_points[i].arm_m = contacts[i].centre_m - tool.position_m;
  }
  const std::size_t placed =
      found.places_proved ? found.contacts : add_likely_places(engine, found, meter);
  return force::push_wrench(engine.search.constraints.first(placed), found.push,
                            engine.push_points.first(placed), tool, engine.settings, engine.places);
}

/// Adds contacts of a search that are nearer than delta to those that there are: those that carry,
/// and the nearest points where there are none, or something is inside and crosses nothing.
/// @return how many are reported then
std::uint32_t report(const Engine& engine, const regions::ContactSearchResult& found,
                     std::uint32_t contacts, double min_distance_m) noexcept {
  const double delta_m = engine.settings.delta_m;
  std::uint32_t count = contacts;
  const auto add = [&](Contact c, double multiplier) {
    if (c.distance_m >= delta_m) return;
    const double apart_m = norm(c.point_a_m - c.point_b_m);
    c.distance_m = c.distance_m < 0 ? -apart_m : apart_m;
    if (c.distance_m >= delta_m || count == engine.contacts.size()) return;
    c.weight = 2 * multiplier / (delta_m - c.distance_m);
    engine.contacts[count++] = c;
  };
  for (const force::Carrying& c : found.push.carrying_contacts()) {
    add(engine.search.contacts[c.index], c.multiplier);
  }
  const bool contained = found.nearest.distance_m < 0 && min_distance_m > 0;
  if (count == 0 || contained) add(found.nearest, 0);
  return count;
}

double least_distance_m(std::span<const Contact> contacts) noexcept {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Contact& c : contacts) least_m = c.distance_m < least_m ? c.distance_m : least_m;
  return least_m;
}

/// Of distances: the nearest found, and a bound of what has not been looked at.
void certify_distance(const Engine& engine, double nearest_m, double lower_m,
                      Certificate& c) noexcept {
  const double delta_m = engine.settings.delta_m;
  c.contact = contact_status(nearest_m < delta_m, lower_m, delta_m);
  const double nearest = nearest_m < delta_m ? nearest_m : delta_m;
  c.error_bound_m = (lower_m < nearest ? nearest - lower_m : 0) + least_error_m(engine.states);
}

/// @param proved  all that is asked for
void certify_push(const Engine& engine, const regions::ContactSearchResult& found, bool proved,
                  const Pace& pace, Certificate& c) noexcept {
  const double least_m = least_error_m(engine.states);
  const double farthest_m = engine.settings.delta_m + least_m;
  const bool near = found.nearest.distance_m < farthest_m || found.lower_m < farthest_m;
  const double error_m = found.error_m + (near ? least_m : 0);
  c.force_bound_N = 2 * engine.settings.stiffness_N_per_m * error_m;
  c.truncated_by_memory |= found.contacts_full;
  c.iteration_cap_met |= found.push.status != force::PushStatus::solved;
  if (found.contacts_full || proved) return;
  c.truncated_by_time |= pace.time_ended();
  c.truncated_by_units |= !pace.time_ended();
}

/// Distances, proved: the minima of all regions, and whether anything is inside, of which they tell
/// nothing.
struct Distances {
  regions::MinimaResult minima;
  bool outside = false;  ///< nothing is inside
  bool ended = false;    ///< by the budget
  /// Of what has not been found; overlap counts as 0.
  [[nodiscard]] double lower_m() const noexcept { return outside ? minima.unresolved_lower_m : 0; }
};

Distances find_distances(Engine& engine, regions::ContactSearch& search, Meter& meter,
                         Pace& pace) noexcept {
  Distances out{regions::find_minima(engine.minima, meter, engine.tally)};
  out.outside = search.see_components(pace);
  out.ended = !pace.go_on();
  return out;
}

/// Proves the push to a tolerance or, where that is 0, the wrench: all of it, or what is cheap.
void prove(regions::ContactSearch& search, Pace& pace, bool exact, double tolerance_m) noexcept {
  const bool whole = tolerance_m == 0;
  if (whole && !exact) pace.limit(kCheapProof);
  search.prove_push(pace);
  if (whole) search.prove_places(pace);
  pace.no_limit();
}

/// The force by the least push: a guess, with three quarters of a budget at most; the distances of
/// all regions, which also tell what edges touch, with half of the rest; then as much proof as is
/// asked for or cheap, which does for a few hundred triangles; and distances with what is left.
/// Without stiffness an exact query asks for distances alone.
Found find_by_regions(Engine& engine, const Budget& budget, Meter& meter,
                      force::PushWrench& push) noexcept {
  const Settings& s = engine.settings;
  const double k = s.stiffness_N_per_m;
  const bool felt = k > 0 || !s.exact;
  const double tolerance_m = !s.exact && k > 0 ? s.force_tolerance_N / (2 * k) : 0;
  regions::ContactSearch search(engine.search, {s.delta_m, tolerance_m});
  Meter first(part_of(budget, 3, 4), {});
  Pace first_pace(first);
  if (felt) search.guess(first_pace);
  meter.charge(first.used());
  meter.expect_contacts(search.contacts());
  engine.tally.lap(Stage::start, meter);
  // Half of what is left, so that the other half may prove the force.
  Meter half(part_of(left_of(budget, meter.used()), 1, felt ? 2 : 1), {});
  Pace half_pace(half);
  Distances distances = find_distances(engine, search, half, half_pace);
  meter.charge(half.used());
  const bool found_any = distances.minima.contacts > 0 || search.nearest_m() < s.delta_m;
  Pace pace(meter);
  const auto undecided = [&] {
    return distances.ended && !found_any && distances.lower_m() < s.delta_m;
  };
  if (undecided() && pace.go_on()) distances = find_distances(engine, search, meter, pace);
  const bool on_reserve = undecided() && meter.has_reserve();
  if (on_reserve) {
    meter.draw_on_reserve();
    pace.resume();
    distances = find_distances(engine, search, meter, pace);
  }
  if (felt) {
    search.see_minima(pace, engine.contacts.first(distances.minima.contacts), engine.minima.edges);
    prove(search, pace, s.exact, tolerance_m);
  }
  if (distances.ended && pace.go_on()) distances = find_distances(engine, search, meter, pace);
  const regions::MinimaResult& minima = distances.minima;
  const std::uint64_t used = meter.used();
  meter.begin_tail();
  engine.tally.lap(Stage::refine, meter.refined_ns());
  const regions::ContactSearchResult& found = search.conclude();
  push = wrench_of(engine, found, meter);
  const std::uint32_t contacts = report(engine, found, minima.contacts, minima.min_distance_m);
  const double nearest_m = least_distance_m(engine.contacts.first(contacts));
  Found out{.contacts = contacts,
            .clusters = found.push.carrying_count,
            .tail_contacts = found.contacts + found.likely,
            .min_distance_m = nearest_m,
            .front_nodes = minima.near_regions,
            .queries = used,
            .certificate = {}};
  Certificate& c = out.certificate;
  c.s_worst = minima.s_worst;
  c.truncated_by_time = minima.truncated_by_time;
  c.truncated_by_units = minima.truncated_by_units;
  c.truncated_by_memory =
      minima.truncated_by_memory || push.places_full || out.contacts == engine.contacts.size();
  c.on_reserve = on_reserve;
  certify_distance(engine, nearest_m, distances.lower_m(), c);
  if (felt) {
    certify_push(engine, found, tolerance_m > 0 ? found.push_proved : found.places_proved, pace, c);
  }
  return out;
}

/// The least push of contacts of pieces; sets their weights. What the surfaces push is only known
/// to be no more than what contacts at the least possible distance push from all sides.
void push_of_pieces(Engine& engine, Found& found, force::PushWrench& out) noexcept {
  const Settings& settings = engine.settings;
  const Pose& tool = engine.poses[engine.tool];
  const std::span<Contact> contacts = engine.contacts.first(found.contacts);
  const std::span<force::PushConstraint> constraints =
      engine.search.constraints.first(contacts.size());
  const std::span<force::PushPoint> points = engine.push_points.first(contacts.size());
  force::set_constraints(contacts, engine.pairs, engine.tool, settings.delta_m, constraints);
  const force::PushResult push = force::least_push(constraints);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    points[i].arm_m = contacts[i].centre_m - tool.position_m;
    contacts[i].weight = 0;
  }
  for (const force::Carrying& c : push.carrying_contacts()) {
    Contact& contact = contacts[c.index];
    contact.weight = 2 * c.multiplier / (settings.delta_m - contact.distance_m);
  }
  out = force::push_wrench(constraints, push, points, tool, settings, engine.places);
  found.clusters = push.carrying_count;
  found.certificate.truncated_by_memory |= out.places_full;
  // Nothing is deeper than the radius, and no way out longer than kMostDetour depths.
  const double deepest_m = -contact::kMostDetour * largest_unit_m(engine.states);
  const double nearest_m = found.contacts > 0 ? found.min_distance_m : settings.delta_m;
  const double lower_m = nearest_m - found.certificate.error_bound_m;
  const double strength_m = settings.delta_m - (lower_m > 0 ? lower_m : deepest_m);
  if (strength_m > 0) {
    found.certificate.force_bound_N =
        2 * settings.stiffness_N_per_m * (norm(push.push.vector) + force::most_push(strength_m));
  }
}

/// Distances by the front of the levels. Its contacts give the force while bodies are apart; where
/// they overlap, and in exact queries, the surfaces do, if the images have them and, but for
/// overlap, the budget proves it. While bodies overlap they have half of the budget.
Found find_by_levels(Engine& engine, const Budget& budget, Meter& meter,
                     force::PushWrench& push) noexcept {
  const Settings& s = engine.settings;
  Meter front(engine.overlapping ? part_of(budget, 1, 2) : budget, engine.tail);
  const levels::QueryResult found = levels::query(engine.levels, rules_of(s), front, engine.tally);
  if (found.queries > 0) follow(engine.levels.query_ns, front.refined_ns() / found.queries);
  meter.charge(front.used());
  Found out{.contacts = found.contacts,
            .tail_contacts = found.contacts,
            .min_distance_m = found.min_distance_m,
            .front_nodes = engine.levels.tree.front().size(),
            .queries = found.queries,
            .certificate = certify_levels(engine, found)};
  engine.overlapping = engine.overlapping || found.min_distance_m <= 0;
  const bool felt = s.stiffness_N_per_m > 0 || !s.exact;
  if (felt && !engine.search.sides.empty() && (s.exact || engine.overlapping)) {
    Pace pace(meter);
    regions::ContactSearch search(engine.search, {s.delta_m, 0});
    search.guess(pace);
    prove(search, pace, s.exact, 0);
    meter.begin_tail();
    const regions::ContactSearchResult& surfaces = search.conclude();
    engine.overlapping = found.min_distance_m <= 0 || surfaces.nearest.distance_m < 0;
    certify_push(engine, surfaces, surfaces.places_proved, pace, out.certificate);
    if (surfaces.places_proved || (engine.overlapping && surfaces.contacts > 0)) {
      push = wrench_of(engine, surfaces, meter);
      out.clusters = surfaces.push.carrying_count;
      out.contacts = report(engine, surfaces, found.contacts, found.min_distance_m);
      out.min_distance_m = least_distance_m(engine.contacts.first(out.contacts));
      out.certificate.truncated_by_memory |= push.places_full;
      return out;
    }
  }
  meter.begin_tail();
  push_of_pieces(engine, out, push);
  return out;
}

}  // namespace

Status tick(Engine& engine, std::span<const Pose> poses, const Budget& budget,
            TickResult& out) noexcept {
  if (poses.size() != engine.bodies) return Status::bad_argument;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!normalise(poses[i], engine.poses[i])) return Status::bad_pose;
  }
  const Settings& settings = engine.settings;
  for (levels::PairState& pair : engine.states) {
    pair.delta = settings.delta_m / pair.unit_m;
    levels::move(pair, engine.poses[pair.body_a], engine.poses[pair.body_b]);
  }
  Meter meter(budget, engine.tail);
  engine.tally.begin_tick();
  force::PushWrench push;
  const Found found = settings.engine == EngineKind::regions
                          ? find_by_regions(engine, budget, meter, push)
                          : find_by_levels(engine, budget, meter, push);
  out.wrench = force::limited(push.wrench, settings);
  out.stiffness = push.stiffness;
  out.clusters = found.clusters;
  out.contacts = engine.contacts.first(found.contacts);
  out.min_distance_m =
      found.contacts > 0 ? found.min_distance_m : std::numeric_limits<double>::quiet_NaN();
  out.front_nodes = found.front_nodes;
  out.queries = found.queries;
  out.certificate = found.certificate;
  out.certificate.units_used = meter.used();
  const std::uint64_t tail_ns = meter.tail_ns();
  engine.tail.learn(tail_ns, found.tail_contacts);
  engine.tally.lap(Stage::force, meter.refined_ns() + tail_ns);
  engine.tally.count([&](auto& counters) { raise_mark(counters.most_contacts, found.contacts); });
  return Status::ok;
}

const Counters* counters(const Engine& engine) noexcept { return engine.tally.counters(); }

void reset_counters(Engine& engine) noexcept { engine.tally.reset(); }

}  // namespace palpate
