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

/// Contacts beyond delta shape the push but are not reported; nor, where all minima are, those that
/// carry nothing.
std::uint32_t keep_reported(std::span<Contact> contacts, const Settings& settings) noexcept {
  std::uint32_t kept = 0;
  for (const Contact& c : contacts) {
    const bool near = c.distance_m < 0 || norm(c.point_a_m - c.point_b_m) < settings.delta_m;
    if (near && (!settings.exact || c.weight > 0)) contacts[kept++] = c;
  }
  return kept;
}

/// How far the push may be off; 0: not at all.
double tolerated_push_m(const Settings& s) noexcept {
  const double twice_k = 2 * s.stiffness_N_per_m;
  return s.exact || !(twice_k > 0) ? 0 : s.force_tolerance_N / twice_k;
}

/// What each contact carries of the force.
void set_weights(std::span<Contact> contacts, const force::PushResult& push,
                 double delta_m) noexcept {
  for (Contact& c : contacts) c.weight = 0;
  for (std::uint32_t i = 0; i < push.carrying_count; ++i) {
    Contact& c = contacts[push.carrying[i].index];
    const double depth_m = delta_m - c.distance_m;
    if (depth_m > 0) c.weight = 2 * push.carrying[i].multiplier / depth_m;
  }
}

/// The minima of all regions, after the contacts that were found for the force.
void add_minima(Engine& engine, Meter& meter, std::uint32_t contacts, Found& found) noexcept {
  engine.regions.contacts = engine.contacts.subspan(contacts);
  const Certificate of_force = found.certificate;
  const double deepest_m = found.min_distance_m;
  found = find_by_regions(engine, meter);
  engine.regions.contacts = engine.contacts;
  found.contacts += contacts;
  found.min_distance_m = deepest_m < found.min_distance_m ? deepest_m : found.min_distance_m;
  found.certificate.force_bound_N = of_force.force_bound_N;
  found.certificate.truncated_by_time |= of_force.truncated_by_time;
  found.certificate.truncated_by_units |= of_force.truncated_by_units;
  found.certificate.truncated_by_memory |= of_force.truncated_by_memory;
}

/// Where the budget ends a search, contacts that are likely place the force beside those measured.
/// @return how many constraints and points there are then
std::size_t add_likely_places(Engine& engine, const regions::ContactSearchResult& found) noexcept {
  std::size_t count = found.contacts;
  for (const regions::LikelyContact& c : engine.search.likely.first(found.likely)) {
    const regions::SideMemory& side = engine.search.sides[c.side];
    if (count == engine.push_points.size()) break;
    if (side.vertices[c.vertex].measured_tick == engine.search.tick) continue;
    const regions::SideView& view = engine.search.views[c.side];
    const Vec3d point = view.side.to_target(contact::position(view.side.points, c.vertex));
    engine.constraints[count] = {vec_cast<double>(c.push), static_cast<double>(c.strength_m)};
    engine.push_points[count].arm_m = view.world(point) - engine.poses[engine.tool].position_m;
    ++count;
  }
  return count;
}

/// Searches for the contacts that can change the least push.
Found find_for_push(Engine& engine, Meter& meter, force::PushWrench& push) noexcept {
  const Settings& s = engine.settings;
  Pace pace(meter);
  const regions::ContactSearchResult found =
      regions::search_contacts(engine.search, {s.delta_m, tolerated_push_m(s)}, pace);
  engine.tally.lap(Stage::refine, meter);
  meter.begin_tail();
  const std::span<Contact> contacts = engine.contacts.first(found.contacts);
  const std::span<force::PushPoint> points = engine.push_points.first(found.contacts);
  const Pose& tool = engine.poses[engine.tool];
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    points[i].arm_m = contacts[i].centre_m - tool.position_m;
  }
  const std::size_t placed = found.complete ? found.contacts : add_likely_places(engine, found);
  push = force::push_wrench(engine.constraints.first(placed), found.push,
                            engine.push_points.first(placed), tool, s, engine.force.places);
  set_weights(contacts, found.push, s.delta_m);
  const double deviation_m = least_error_m(engine.states);
  Found out;
  out.contacts = keep_reported(contacts, s);
  out.clusters = found.push.carrying_count;
  out.tail_contacts = found.contacts;
  out.min_distance_m = found.min_distance_m;
  out.front_nodes = found.near_regions;
  out.certificate.force_bound_N =
      2 * s.stiffness_N_per_m * (regions::push_error_m(found) + deviation_m);
  out.certificate.truncated_by_memory = found.contacts_full;
  out.certificate.iteration_cap_met = found.push.status != force::PushStatus::solved;
  if (!found.complete && !found.contacts_full) {
    out.certificate.truncated_by_units = meter.out_of_units();
    out.certificate.truncated_by_time = !out.certificate.truncated_by_units;
  }
  const std::uint32_t for_force = out.contacts;
  if (s.exact) {
    add_minima(engine, meter, for_force, out);
  } else {
    const double nearest_m =
        out.contacts > 0 && out.min_distance_m < s.delta_m ? out.min_distance_m : s.delta_m;
    const double below_m =
        found.unresolved_lower_m < nearest_m ? nearest_m - found.unresolved_lower_m : 0;
    out.certificate.error_bound_m = below_m + deviation_m;
    if (out.contacts > 0) {
      out.certificate.contact = ContactStatus::found;
    } else if (!(found.unresolved_lower_m < s.delta_m)) {
      out.certificate.contact = ContactStatus::ruled_out;
    }
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
  if (settings.force_law == ForceLaw::least_push) {
    force::PushWrench push;
    found = find_for_push(engine, meter, push);
    out.wrench = force::limited(push.wrench, settings);
    out.stiffness = push.stiffness;
    out.clusters = found.clusters;
    found.certificate.truncated_by_memory |= push.places_full;
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
