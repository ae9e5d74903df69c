// SPDX-License-Identifier: Apache-2.0
// Set-up and the tick: poses, query, force, certificate.
#include <limits>

#include "rt_core/base/arena.hpp"
#include "rt_core/base/meter.hpp"
#include "rt_core/force/penalty.hpp"
#include "rt_core/levels/levels_engine.hpp"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/regions/regions_engine.hpp"

namespace palpate {

class Engine {
 public:
  std::span<const BodyPair> pairs;
  std::uint32_t bodies = 0;
  std::uint32_t tool = 0;
  Settings settings;
  std::span<Pose> poses;                // of this tick, normalised
  std::span<levels::PairState> states;  // [pairs]
  levels::QueryMemory levels;           // of the engine's kind; the other is empty
  regions::QueryMemory regions;
  std::span<Contact> contacts;
  force::Workspace force;
  std::uint64_t tail_ns = 0;  // what ticks take from the end of refinement to their own, smoothed
};

namespace {

constexpr double kUnitQuaternion = 1e-3;
/// What rounding of float vertices, transforms and queries leaves of a distance, in units of the
/// larger radius.
constexpr double kNumericalError = 5e-7;

bool finite(double v) noexcept { return v - v == 0; }
bool finite(Vec3d v) noexcept { return finite(v.x) && finite(v.y) && finite(v.z); }
bool at_least(double v, double least) noexcept { return v >= least; }  // false for NaN

bool sound(const Settings& s) noexcept {
  return finite(s.delta_m) && s.delta_m > 0 && finite(s.s0) && at_least(s.s0, 0) &&
         at_least(s.kappa, 0) && s.bounds <= Bounds::paper && s.order <= Order::ratio &&
         finite(s.stiffness_N_per_m) && at_least(s.stiffness_N_per_m, 0) &&
         finite(s.cluster_radius_m) && at_least(s.cluster_radius_m, 0) &&
         finite(s.force_tolerance_N) && at_least(s.force_tolerance_N, 0) &&
         at_least(s.max_force_N, 0) && at_least(s.max_torque_Nm, 0);
}

bool sound(const Scene& scene, const Limits& limits) noexcept {
  const std::size_t bodies = scene.bodies.size();
  if (bodies == 0 || bodies > kMaxBodies || scene.pairs.empty() || scene.pairs.size() > kMaxPairs ||
      scene.tool >= bodies)
    return false;
  for (const ImageView& body : scene.bodies) {
    if (body.header == nullptr) return false;
  }
  for (const BodyPair& pair : scene.pairs) {
    if (pair.a >= bodies || pair.b >= bodies || pair.a == pair.b) return false;
  }
  return limits.nodes >= scene.pairs.size() && limits.nodes < levels::kNone &&
         limits.contacts > 0 && limits.clusters > 0;
}

// All memory of an engine: counted and handed out by the same lines.

void lay_out_levels(Arena& arena, const Limits& limits, levels::QueryMemory& out) noexcept {
  const auto nodes = arena.array<levels::Node>(limits.nodes);
  const auto front = arena.array<std::uint32_t>(limits.nodes);
  const auto blending = arena.array<std::uint32_t>(limits.nodes);
  const auto waiting = arena.array<levels::Waiting>(limits.nodes);
  const auto stopped = arena.array<std::uint32_t>(limits.nodes);
  const auto scratch = arena.array<convex::PenetrationScratch>(1);
  if (scratch.empty()) return;
  out.tree = levels::TestTree(nodes, front, blending);
  out.waiting = waiting;
  out.stopped = stopped;
  out.scratch = &scratch[0];
}

std::size_t regions_of(const Scene& scene, const BodyPair& pair) noexcept {
  return scene.bodies[pair.a].regions.size();
}

void lay_out_regions(Arena& arena, const Scene& scene, regions::QueryMemory& out) noexcept {
  std::size_t all = 0;
  std::size_t most = 0;
  for (const BodyPair& pair : scene.pairs) {
    const std::size_t count = regions_of(scene, pair);
    all += count;
    most = count > most ? count : most;
  }
  out.frames = arena.array<regions::PairFrame>(scene.pairs.size());
  out.first_state = arena.array<std::uint32_t>(scene.pairs.size());
  out.states = arena.array<regions::RegionState>(all);
  out.active = arena.array<regions::Active>(all);
  out.queue = arena.array<std::uint32_t>(all);
  out.swept = arena.array<regions::Swept>(most);
  const auto search = arena.array<regions::SearchScratch>(1);
  const auto crossing = arena.array<regions::CrossingScratch>(1);
  if (crossing.empty()) return;
  out.search = &search[0];
  out.crossing = &crossing[0];
}

Engine* lay_out(Arena& arena, const Scene& scene, const Limits& limits, EngineKind kind) noexcept {
  const auto engine = arena.array<Engine>(1);
  const auto states = arena.array<levels::PairState>(scene.pairs.size());
  const auto poses = arena.array<Pose>(scene.bodies.size());
  const auto contacts = arena.array<Contact>(limits.contacts);
  const auto felt = arena.array<force::Felt>(limits.contacts);
  const auto ranking = arena.array<force::Ranked>(limits.contacts);
  const auto places = arena.array<force::Place>(limits.clusters);
  levels::QueryMemory levels;
  regions::QueryMemory regions;
  if (kind == EngineKind::levels) {
    lay_out_levels(arena, limits, levels);
  } else {
    lay_out_regions(arena, scene, regions);
  }
  if (engine.empty() || (levels.scratch == nullptr && regions.crossing == nullptr)) return nullptr;
  Engine& e = engine[0];
  e.poses = poses;
  e.states = states;
  e.contacts = contacts;
  e.force = {felt, ranking, force::Places(places)};
  e.levels = levels;
  e.regions = regions;
  e.levels.pairs = e.regions.pairs = states;
  e.levels.contacts = e.regions.contacts = contacts;
  return &e;
}

void set_up(levels::PairState& pair, const Scene& scene, const BodyPair& bodies) noexcept {
  pair.image_a = &scene.bodies[bodies.a];
  pair.image_b = &scene.bodies[bodies.b];
  pair.body_a = bodies.a;
  pair.body_b = bodies.b;
  const double radius_a = pair.image_a->header->radius_m;
  const double radius_b = pair.image_b->header->radius_m;
  pair.unit_m = radius_a > radius_b ? radius_a : radius_b;
  pair.scale_a = radius_a / pair.unit_m;
  pair.scale_b = radius_b / pair.unit_m;
}

bool normalise(const Pose& in, Pose& out) noexcept {
  const Quat& q = in.orientation;
  const double length = sqrt_of(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!finite(in.position_m) || !(length >= 1 - kUnitQuaternion && length <= 1 + kUnitQuaternion))
    return false;
  out.position_m = in.position_m;
  out.orientation = {q.w / length, q.x / length, q.y / length, q.z / length};
  return true;
}

/// Does an image without its finest levels serve these settings against this partner?
bool is_fine_enough(const ImageView& image, const ImageView& partner,
                    const Settings& settings) noexcept {
  const image::Header& header = *image.header;
  if (header.dropped_levels == 0) return true;
  const image::Level& finest = image.levels[0];
  const double ratio = partner.header->radius_m / header.radius_m;
  const double area = static_cast<double>(partner.levels[0].min_support_area_rel) * ratio * ratio;
  const double s_m = static_cast<double>(finest.max_surface_deviation_rel) * header.radius_m;
  return !settings.exact && settings.s0 >= static_cast<double>(header.s0_min) &&
         area >= static_cast<double>(header.partner_area) &&
         (s_m <= settings.kappa * settings.delta_m);
}

bool all_fine_enough(const Engine& engine, const Settings& settings) noexcept {
  if (settings.engine != EngineKind::levels) return true;
  for (const levels::PairState& pair : engine.states) {
    if (!is_fine_enough(*pair.image_a, *pair.image_b, settings) ||
        !is_fine_enough(*pair.image_b, *pair.image_a, settings)) {
      return false;
    }
  }
  return true;
}

levels::Rules rules_of(const Settings& settings) noexcept {
  return {.exact = settings.exact,
          .interpolate = settings.interpolate,
          .front_tracking = settings.front_tracking,
          .motion_bounds = settings.motion_bounds,
          .root_short_cut = settings.root_short_cut,
          .stop_on_surface = settings.stop_on_surface,
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

/// Follows the tail within a few ticks; one that was interrupted by the host counts for little.
std::uint64_t smoothed(std::uint64_t before_ns, std::uint64_t now_ns) noexcept {
  constexpr std::uint64_t kLeast_ns = 1000;
  const std::uint64_t most = 4 * before_ns + kLeast_ns;
  return (3 * before_ns + (now_ns < most ? now_ns : most)) / 4;
}

/// What both queries say of their answer.
template <class QueryResult>
Certificate certify(const QueryResult& found, double upper_m, double delta_m,
                    double unit_m) noexcept {
  Certificate c;
  const double nearest =
      found.contacts > 0 && found.min_distance_m < delta_m ? found.min_distance_m : delta_m;
  const double below = found.unresolved_lower_m < nearest ? nearest - found.unresolved_lower_m : 0;
  const double above = found.contacts > 0 && upper_m > nearest ? upper_m - nearest : 0;
  c.error_bound_m = (below > above ? below : above) + found.capped_gap_m + kNumericalError * unit_m;
  c.s_worst = found.s_worst;
  c.truncated_by_time = found.truncated_by_time;
  c.truncated_by_units = found.truncated_by_units;
  c.truncated_by_memory = found.truncated_by_memory;
  c.iteration_cap_met = found.iteration_cap_met;
  return c;
}

/// What a tick is made of, whichever engine found it.
struct Found {
  std::uint32_t contacts = 0;
  double min_distance_m = 0;
  std::uint64_t front_nodes = 0;
  std::uint64_t queries = 0;
  Certificate certificate;
};

Found find_by_levels(Engine& engine, Meter& meter) noexcept {
  const levels::QueryResult found = levels::query(engine.levels, rules_of(engine.settings), meter);
  if (found.queries > 0) {
    engine.levels.query_ns = smoothed(engine.levels.query_ns, meter.refined_ns() / found.queries);
  }
  return {found.contacts, found.min_distance_m, engine.levels.tree.front().size(), found.queries,
          certify(found, found.upper_m, engine.settings.delta_m, largest_unit_m(engine.states))};
}

bool limited(const Budget& budget) noexcept {
  return budget.clock_ns != nullptr || budget.units != Budget{}.units;
}

Found find_by_regions(Engine& engine, const Budget& budget, Meter& meter) noexcept {
  const Settings& s = engine.settings;
  regions::Demand demand;
  demand.limited = limited(budget);
  if (!s.exact && s.stiffness_N_per_m > 0) {
    demand.tolerance_m = s.force_tolerance_N / s.stiffness_N_per_m;
  }
  const regions::QueryResult found = regions::query(engine.regions, demand, meter);
  Found out{found.contacts, found.min_distance_m, found.near_regions, found.queries,
            certify(found, found.min_distance_m, s.delta_m, largest_unit_m(engine.states))};
  out.certificate.force_bound_N = s.stiffness_N_per_m * found.open_m;
  return out;
}

bool serves(const ImageView& image, EngineKind kind) noexcept {
  return !image.pieces.empty() && (kind == EngineKind::levels || !image.regions.empty());
}

void begin_levels(levels::QueryMemory& memory) noexcept {
  for (std::uint32_t i = 0; i < memory.pairs.size(); ++i) {
    memory.pairs[i].root = memory.tree.add_root(static_cast<std::uint16_t>(i), 0, 0);
  }
}

void begin_regions(const Scene& scene, regions::QueryMemory& memory) noexcept {
  memory.kernels = &regions::best_kernels();
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    memory.first_state[i] = first;
    first += static_cast<std::uint32_t>(regions_of(scene, scene.pairs[i]));
  }
}

}  // namespace

std::size_t required_bytes(const Scene& scene, const Limits& limits, EngineKind engine) noexcept {
  if (!sound(scene, limits)) return 0;
  Arena count;
  static_cast<void>(lay_out(count, scene, limits, engine));
  return count.used();
}

Status create(const Scene& scene, const Settings& settings, const Limits& limits,
              std::span<std::byte> memory, Engine*& out_engine) noexcept {
  if (!sound(scene, limits) || !sound(settings)) return Status::bad_argument;
  for (const ImageView& body : scene.bodies) {
    if (!serves(body, settings.engine)) return Status::image_missing_section;
  }
  if (memory.size() < required_bytes(scene, limits, settings.engine) ||
      reinterpret_cast<std::uintptr_t>(memory.data()) % Arena::kAlignment != 0) {
    return Status::not_enough_memory;
  }
  Arena arena(memory);
  Engine* engine = lay_out(arena, scene, limits, settings.engine);
  if (engine == nullptr) return Status::not_enough_memory;
  engine->pairs = scene.pairs;
  engine->bodies = static_cast<std::uint32_t>(scene.bodies.size());
  engine->tool = scene.tool;
  engine->settings = settings;
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    set_up(engine->states[i], scene, scene.pairs[i]);
  }
  if (settings.engine == EngineKind::levels) {
    begin_levels(engine->levels);
  } else {
    begin_regions(scene, engine->regions);
  }
  if (!all_fine_enough(*engine, settings)) return Status::image_too_coarse;
  out_engine = engine;
  return Status::ok;
}

Status configure(Engine& engine, const Settings& settings) noexcept {
  if (!sound(settings) || settings.engine != engine.settings.engine) return Status::bad_argument;
  if (!all_fine_enough(engine, settings)) return Status::image_too_coarse;
  engine.settings = settings;
  return Status::ok;
}

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
  Meter meter(budget, engine.tail_ns + engine.tail_ns / 4);
  const Found found = settings.engine == EngineKind::levels
                          ? find_by_levels(engine, meter)
                          : find_by_regions(engine, budget, meter);

  const std::span<Contact> contacts = engine.contacts.first(found.contacts);
  out.contacts = contacts;
  const force::Penalty penalty = force::penalty(contacts, engine.pairs, engine.tool,
                                                engine.poses[engine.tool], settings, engine.force);
  out.wrench = force::limited(penalty.wrench, settings);
  out.stiffness = penalty.stiffness;
  out.clusters = static_cast<std::uint32_t>(2 * penalty.directions + 1) / 2;  // rounded
  out.min_distance_m =
      found.contacts > 0 ? found.min_distance_m : std::numeric_limits<double>::quiet_NaN();
  out.front_nodes = found.front_nodes;
  out.queries = found.queries;
  out.certificate = found.certificate;
  out.certificate.units_used = meter.used();
  out.certificate.truncated_by_memory |= penalty.places_full;
  engine.tail_ns = smoothed(engine.tail_ns, meter.tail_ns());
  return Status::ok;
}

}  // namespace palpate
