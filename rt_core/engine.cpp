// SPDX-License-Identifier: Apache-2.0
// The tick: poses, query, force, certificate.
#include "rt_core/engine.hpp"

#include <limits>

#include "rt_core/base/meter.hpp"
#include "rt_core/force/constraints.hpp"
#include "rt_core/force/penalty.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate {
namespace {

constexpr double kUnitQuaternion = 1e-3;
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
          .interpolate = settings.interpolate,
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

template <class QueryResult>
ContactStatus contact_status(const QueryResult& found, double delta_m) noexcept {
  if (found.contacts > 0) return ContactStatus::found;
  const bool open = found.unresolved_lower_m < delta_m || found.capped_gap_m > 0;
  return open ? ContactStatus::undecided : ContactStatus::ruled_out;
}

/// What both queries say of their answer.
template <class QueryResult>
Certificate certify(const QueryResult& found, double upper_m, double delta_m,
                    double least_error_m) noexcept {
  Certificate c;
  c.contact = contact_status(found, delta_m);
  const double nearest =
      found.contacts > 0 && found.min_distance_m < delta_m ? found.min_distance_m : delta_m;
  const double below = found.unresolved_lower_m < nearest ? nearest - found.unresolved_lower_m : 0;
  const double above = found.contacts > 0 && upper_m > nearest ? upper_m - nearest : 0;
  c.error_bound_m = (below > above ? below : above) + found.capped_gap_m + least_error_m;
  c.s_worst = found.s_worst;
  c.truncated_by_time = found.truncated_by_time;
  c.truncated_by_units = found.truncated_by_units;
  c.truncated_by_memory = found.truncated_by_memory;
  c.iteration_cap_met = found.iteration_cap_met;
  return c;
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

Found find_by_levels(Engine& engine, Meter& meter) noexcept {
  const levels::QueryResult found =
      levels::query(engine.levels, rules_of(engine.settings), meter, engine.tally);
  if (found.queries > 0) {
    follow(engine.levels.query_ns, meter.refined_ns() / found.queries);
  }
  return {.contacts = found.contacts,
          .tail_contacts = found.contacts,
          .min_distance_m = found.min_distance_m,
          .front_nodes = engine.levels.tree.front().size(),
          .queries = found.queries,
          .certificate =
              certify(found, found.upper_m, engine.settings.delta_m, least_error_m(engine.states))};
}

Found find_by_regions(Engine& engine, Meter& meter) noexcept {
  const Settings& s = engine.settings;
  regions::Demand demand;
  demand.limited = meter.limited();
  if (!s.exact && s.stiffness_N_per_m > 0) {
    demand.tolerance_m = s.force_tolerance_N / s.stiffness_N_per_m;
  }
  const regions::QueryResult found = regions::query(engine.regions, demand, meter, engine.tally);
  Found out{.contacts = found.contacts,
            .tail_contacts = regions::tail_contacts(found.contacts, found.crossings),
            .min_distance_m = found.min_distance_m,
            .front_nodes = found.near_regions,
            .queries = found.queries,
            .certificate = certify(found, found.maybe_apart ? s.delta_m : found.min_distance_m,
                                   s.delta_m, least_error_m(engine.states))};
  out.certificate.force_bound_N = s.stiffness_N_per_m * found.open_m;
  out.certificate.on_reserve = found.on_reserve;
  return out;
}

/// So much of a budget, from now on.
Budget part_of(const Budget& budget, std::uint64_t numerator, std::uint64_t denominator) noexcept {
  constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
  Budget out = budget;
  out.reserve_units = out.reserve_ns = 0;
  if (out.units != kUnlimited) out.units = out.units / denominator * numerator;
  if (out.clock_ns == nullptr || out.deadline_ns == kUnlimited) return out;
  const std::uint64_t now = out.clock_ns(out.clock_context);
  const std::uint64_t left = out.deadline_ns > now ? out.deadline_ns - now : 0;
  out.deadline_ns = now + left / denominator * numerator;
  return out;
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
    if (search.sides[c.side].vertices[c.vertex].measured_tick == search.tick) continue;
    const Vec3d normal = vec_cast<double>(c.push);
    const double strength_m = static_cast<double>(c.strength_m);
    if (strength_m <= force::kTakesPart * found.push.push.along(normal)) continue;
    const regions::SideView& view = search.views[c.side];
    const Vec3d point = view.side.to_target(contact::position(view.side.points, c.vertex));
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
                            engine.push_points.first(placed), tool, engine.settings,
                            engine.force.places);
}

/// Adds those contacts that carry the push to the others, which carry nothing.
void report_carrying(Engine& engine, const regions::ContactSearchResult& push,
                     Found& found) noexcept {
  const double delta_m = engine.settings.delta_m;
  for (Contact& c : engine.contacts.first(found.contacts)) c.weight = 0;
  for (std::uint32_t i = 0; i < push.push.carrying_count; ++i) {
    const force::Carrying& carrying = push.push.carrying[i];
    Contact c = engine.search.contacts[carrying.index];
    const double apart_m = c.distance_m < 0 ? c.distance_m : norm(c.point_a_m - c.point_b_m);
    if (apart_m >= delta_m || found.contacts == engine.contacts.size()) continue;
    found.certificate.contact = ContactStatus::found;
    if (apart_m < found.min_distance_m) found.min_distance_m = apart_m;
    c.weight = 2 * carrying.multiplier / (delta_m - c.distance_m);
    engine.contacts[found.contacts++] = c;
  }
}

/// The force by the least push; distances and their certificate by the minima of all regions. What
/// is likely comes first, with three quarters of the budget at most; then the minima; proof that
/// nothing else changes the force is for exact queries.
Found find_for_push(Engine& engine, const Budget& budget, Meter& meter,
                    force::PushWrench& push) noexcept {
  constexpr std::uint64_t kGuess[] = {3, 4};
  const Settings& s = engine.settings;
  regions::ContactSearch search(engine.search, s.delta_m);
  Meter first(part_of(budget, kGuess[0], kGuess[1]), {});
  Pace first_pace(first);
  const bool guessed = search.guess(first_pace);
  meter.charge(first.used());
  meter.expect_contacts(search.contacts());
  Found out = find_by_regions(engine, meter);
  Pace pace(meter);
  if (s.exact) {
    search.prove_push(pace);
    search.prove_places(pace);
  }
  const regions::ContactSearchResult& found = search.conclude();
  push = wrench_of(engine, found, meter);
  report_carrying(engine, found, out);
  out.clusters = found.push.carrying_count;
  out.tail_contacts += search.contacts();
  Certificate& c = out.certificate;
  c.force_bound_N = 2 * s.stiffness_N_per_m * (found.error_m + least_error_m(engine.states));
  c.truncated_by_memory |= found.contacts_full || push.places_full;
  c.iteration_cap_met |= found.push.status != force::PushStatus::solved;
  if (!(s.exact ? found.places_proved : guessed) && !found.contacts_full) {
    const bool by_units = meter.out_of_units() || first.out_of_units();
    c.truncated_by_units |= by_units;
    c.truncated_by_time |= !by_units;
  }
  out.queries = meter.used();
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
  Found found;
  if (settings.engine == EngineKind::regions && settings.force_law == ForceLaw::least_push) {
    force::PushWrench push;
    found = find_for_push(engine, budget, meter, push);
    out.wrench = force::limited(push.wrench, settings);
    out.stiffness = push.stiffness;
    out.clusters = found.clusters;
  } else {
    found = settings.engine == EngineKind::levels ? find_by_levels(engine, meter)
                                                  : find_by_regions(engine, meter);
    const force::Penalty penalty =
        force::penalty(engine.contacts.first(found.contacts), engine.pairs, engine.tool,
                       engine.poses[engine.tool], settings, engine.force);
    out.wrench = force::limited(penalty.wrench, settings);
    out.stiffness = penalty.stiffness;
    out.clusters = static_cast<std::uint32_t>(2 * penalty.directions + 1) / 2;  // rounded
    found.certificate.truncated_by_memory |= penalty.places_full;
  }
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
