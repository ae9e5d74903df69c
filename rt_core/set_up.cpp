// SPDX-License-Identifier: Apache-2.0
// Set-up: the memory of an engine, its settings, and engines that have been moved.
#include <initializer_list>

#include "rt_core/base/arena.hpp"
#include "rt_core/contact/found.hpp"
#include "rt_core/engine.hpp"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/workspace.hpp"

namespace palpate {
namespace {

bool finite(double v) noexcept { return v - v == 0; }
bool at_least(double v, double least) noexcept { return v >= least; }  // false for NaN

bool sound(const Settings& s) noexcept {
  return finite(s.delta_m) && s.delta_m > 0 && finite(s.s0) && at_least(s.s0, 0) &&
         at_least(s.kappa, 0) && s.bounds <= Bounds::paper && s.order <= Order::force &&
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
         limits.contacts > 0 && limits.contacts < force::Spot::kNone / force::Spot::kCorners &&
         limits.clusters > 0;
}

/// All memory of an engine: counted, handed out and found again by the same lines.
struct Layout {
  std::span<Engine> engine;
  std::span<levels::PairState> states;
  std::span<Pose> poses;
  std::span<Contact> contacts;
  std::span<force::PushConstraint> constraints;
  std::span<force::PushPoint> push_points;
  std::span<force::Place> places;
  // Levels engine.
  std::span<levels::Node> nodes;
  std::span<std::uint32_t> front, stopped;
  std::span<levels::Waiting> waiting;
  std::span<convex::PenetrationScratch> scratch;
  std::span<convex::PressureScratch> pressure;
  // Regions engine.
  std::span<regions::PairFrame> frames;
  std::span<std::uint32_t> first_state, queue, edges;
  std::span<regions::RegionState> regions;
  std::span<regions::Witness> witnesses;
  std::span<regions::RegionPairs> kept;
  std::span<regions::Active> active;
  std::span<float> swept;
  std::span<double> lasting;
  std::span<regions::SearchScratch> search;
  // The search for the least push.
  std::span<Contact> measured;
  std::span<regions::SideMemory> sides;
  std::span<regions::SideView> views;
  std::span<contact::Scratch> contact_scratch;
  std::span<regions::RegionBound> region_bounds;
  std::span<regions::VertexBound> vertex_bounds;
  std::span<std::uint32_t> edge_ticks;
  std::span<regions::NearRegion> near;
  std::span<std::uint32_t> open;
  std::span<regions::ContactSource> sources;
  std::span<regions::LikelyContact> likely;
  std::span<regions::LikelyRegion> likely_regions;
  std::span<double> likely_vertices;
};

std::size_t smaller(std::size_t a, std::size_t b) noexcept { return a < b ? a : b; }
std::size_t larger(std::size_t a, std::size_t b) noexcept { return a < b ? b : a; }

std::size_t regions_of(const Scene& scene, const BodyPair& pair) noexcept {
  return scene.bodies[pair.a].regions.size();
}

std::size_t regions_of(const Scene& scene) noexcept {
  std::size_t all = 0;
  for (const BodyPair& pair : scene.pairs) all += regions_of(scene, pair);
  return all;
}

/// What the search for the least push reads.
bool has_surface(const ImageView& image) noexcept {
  return !image.regions.empty() && !image.surface_vertices.empty() &&
         image.proximity_grid != nullptr;
}

bool have_surfaces(const Scene& scene) noexcept {
  for (const ImageView& body : scene.bodies) {
    if (!has_surface(body)) return false;
  }
  return true;
}

/// What both sides of all pairs need.
struct SideCounts {
  std::size_t regions = 0, vertices = 0, edges = 0;
};
SideCounts sides_of(const Scene& scene) noexcept {
  SideCounts out;
  for (const BodyPair& pair : scene.pairs) {
    for (const std::uint32_t body : {pair.a, pair.b}) {
      out.regions += scene.bodies[body].regions.size();
      out.vertices += scene.bodies[body].surface_vertices.size();
      out.edges += scene.bodies[body].surface_edges.size();
    }
  }
  return out;
}

/// What limits ask for, but no more than vertices and edges can have.
std::size_t contacts_for(const Scene& scene, const Limits& limits) noexcept {
  const SideCounts counts = sides_of(scene);
  return smaller(limits.contacts, contact::kMostFound * (counts.vertices + counts.edges));
}

void lay_out_levels(Arena& arena, const Limits& limits, Layout& out) noexcept {
  out.nodes = arena.array<levels::Node>(limits.nodes);
  out.front = arena.array<std::uint32_t>(limits.nodes);
  out.waiting = arena.array<levels::Waiting>(limits.nodes);
  out.stopped = arena.array<std::uint32_t>(limits.nodes);
  out.scratch = arena.array<convex::PenetrationScratch>(1);
  out.pressure = arena.array<convex::PressureScratch>(1);
}

void lay_out_search(Arena& arena, const Scene& scene, const Limits& limits, Layout& out) noexcept {
  const SideCounts counts = sides_of(scene);
  const std::size_t contacts = contacts_for(scene, limits);
  out.measured = arena.array<Contact>(contacts);
  out.sides = arena.array<regions::SideMemory>(2 * scene.pairs.size());
  out.views = arena.array<regions::SideView>(2 * scene.pairs.size());
  out.contact_scratch = arena.array<contact::Scratch>(1);
  out.region_bounds = arena.array<regions::RegionBound>(counts.regions);
  out.vertex_bounds = arena.array<regions::VertexBound>(counts.vertices);
  out.edge_ticks = arena.array<std::uint32_t>(counts.edges);
  out.near = arena.array<regions::NearRegion>(counts.regions);
  out.open = arena.array<std::uint32_t>(counts.regions);
  out.sources = arena.array<regions::ContactSource>(contacts);
  out.likely = arena.array<regions::LikelyContact>(counts.vertices);
  out.likely_regions = arena.array<regions::LikelyRegion>(counts.regions);
  out.likely_vertices = arena.array<double>(counts.vertices);
}

void lay_out_regions(Arena& arena, const Scene& scene, Layout& out) noexcept {
  const std::size_t all = regions_of(scene);
  std::size_t most = 0;
  for (const BodyPair& pair : scene.pairs) most = larger(most, regions_of(scene, pair));
  out.frames = arena.array<regions::PairFrame>(scene.pairs.size());
  out.first_state = arena.array<std::uint32_t>(scene.pairs.size());
  out.regions = arena.array<regions::RegionState>(all);
  out.witnesses = arena.array<regions::Witness>(all);
  out.kept = arena.array<regions::RegionPairs>(all);
  out.active = arena.array<regions::Active>(all);
  out.queue = arena.array<std::uint32_t>(all);
  out.edges = arena.array<std::uint32_t>(all);
  out.swept = arena.array<float>(most);
  out.lasting = arena.array<double>(all);
  out.search = arena.array<regions::SearchScratch>(1);
}

Layout lay_out(Arena& arena, const Scene& scene, const Limits& limits, EngineKind kind) noexcept {
  Layout out;
  out.engine = arena.array<Engine>(1);
  out.states = arena.array<levels::PairState>(scene.pairs.size());
  out.poses = arena.array<Pose>(scene.bodies.size());
  const std::size_t contacts =
      kind == EngineKind::levels ? limits.contacts : contacts_for(scene, limits);
  out.contacts = arena.array<Contact>(contacts);
  out.constraints = arena.array<force::PushConstraint>(contacts);
  out.push_points = arena.array<force::PushPoint>(contacts);
  out.places = arena.array<force::Place>(limits.clusters);
  if (kind == EngineKind::levels) {
    lay_out_levels(arena, limits, out);
  } else {
    lay_out_regions(arena, scene, out);
  }
  if (have_surfaces(scene)) lay_out_search(arena, scene, limits, out);
  return out;
}

/// Lets a pair of bodies see its images.
void attach(levels::PairState& pair, const Scene& scene, const BodyPair& bodies) noexcept {
  pair.image_a = &scene.bodies[bodies.a];
  pair.image_b = &scene.bodies[bodies.b];
}

void attach_sides(const Layout& layout, const Scene& scene) noexcept {
  SideCounts first;
  for (std::size_t i = 0; i < layout.sides.size(); ++i) {
    const BodyPair& pair = scene.pairs[i / 2];
    const ImageView& points = scene.bodies[i % 2 == 0 ? pair.a : pair.b];
    regions::SideMemory& side = layout.sides[i];
    side.regions = layout.region_bounds.subspan(first.regions, points.regions.size());
    side.vertices = layout.vertex_bounds.subspan(first.vertices, points.surface_vertices.size());
    side.edge_ticks = layout.edge_ticks.subspan(first.edges, points.surface_edges.size());
    side.likely.regions = layout.likely_regions.subspan(first.regions, points.regions.size());
    side.likely.vertices =
        layout.likely_vertices.subspan(first.vertices, points.surface_vertices.size());
    first.regions += points.regions.size();
    first.vertices += points.surface_vertices.size();
    first.edges += points.surface_edges.size();
  }
}

void attach_search(const Layout& layout, const Scene& scene, Engine& e) noexcept {
  attach_sides(layout, scene);
  e.search.pairs = layout.states;
  e.search.contacts = layout.measured;
  e.search.kernels = &regions::best_kernels();
  e.search.bodies = scene.pairs;
  e.search.tool = scene.tool;
  e.search.sides = layout.sides;
  e.search.views = layout.views;
  e.search.scratch = layout.contact_scratch.data();
  e.search.near = layout.near;
  e.search.queue = layout.open;
  e.search.sources = layout.sources;
  e.search.likely = layout.likely;
}

/// Points the engine to its memory and its scene. Values stay as they are.
Engine& attach(const Layout& layout, const Scene& scene) noexcept {
  Engine& e = layout.engine[0];
  e.pairs = scene.pairs;
  e.poses = layout.poses;
  e.states = layout.states;
  e.contacts = layout.contacts;
  e.places.attach(layout.places);
  e.levels.pairs = e.minima.pairs = layout.states;
  e.levels.contacts = e.minima.contacts = layout.contacts;
  e.levels.tree.attach(layout.nodes, layout.front);
  e.levels.waiting = layout.waiting;
  e.levels.stopped = layout.stopped;
  e.levels.scratch = layout.scratch.data();
  e.levels.pressure = layout.pressure.data();
  e.minima.kernels = &regions::best_kernels();
  e.minima.frames = layout.frames;
  e.minima.first_state = layout.first_state;
  e.minima.states = layout.regions;
  e.minima.witnesses = layout.witnesses;
  e.minima.kept = layout.kept;
  e.minima.active = layout.active;
  e.minima.queue = layout.queue;
  e.minima.edges = layout.edges;
  e.minima.swept = layout.swept;
  e.minima.lasting = layout.lasting;
  e.minima.search = layout.search.data();
  e.search.constraints = layout.constraints;
  e.push_points = layout.push_points;
  if (!layout.sides.empty()) attach_search(layout, scene, e);
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    attach(layout.states[i], scene, scene.pairs[i]);
  }
  return e;
}

void begin(levels::PairState& pair, const BodyPair& bodies) noexcept {
  pair.body_a = bodies.a;
  pair.body_b = bodies.b;
  const double radius_a = pair.image_a->header->radius_m;
  const double radius_b = pair.image_b->header->radius_m;
  pair.unit_m = radius_a > radius_b ? radius_a : radius_b;
  pair.scale_a = radius_a / pair.unit_m;
  pair.scale_b = radius_b / pair.unit_m;
  pair.deviation = pair.scale_a * static_cast<double>(pair.image_a->header->source_deviation_rel) +
                   pair.scale_b * static_cast<double>(pair.image_b->header->source_deviation_rel);
}

void begin_levels(levels::QueryMemory& memory) noexcept {
  memory.tree.clear();
  for (std::uint32_t i = 0; i < memory.pairs.size(); ++i) {
    memory.pairs[i].root = memory.tree.add_root(static_cast<std::uint16_t>(i), 0, 0);
  }
}

void begin_regions(const Scene& scene, regions::MinimaMemory& memory) noexcept {
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    memory.first_state[i] = first;
    first += static_cast<std::uint32_t>(regions_of(scene, scene.pairs[i]));
  }
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
  for (const levels::PairState& pair : engine.states) {
    if (pair.deviation * pair.unit_m >= settings.delta_m) return false;
    if (settings.engine != EngineKind::levels) continue;
    if (!is_fine_enough(*pair.image_a, *pair.image_b, settings) ||
        !is_fine_enough(*pair.image_b, *pair.image_a, settings)) {
      return false;
    }
  }
  return true;
}

bool serves(const ImageView& image, const Settings& settings) noexcept {
  return !image.pieces.empty() && (settings.engine == EngineKind::levels || has_surface(image));
}

/// FNV-1a (Fowler, Noll, Vo) of all that the layout and the meaning of an engine's memory follow
/// from: two engines of one build with the same value can have each other's bytes.
class Imprint {
 public:
  void add(std::uint64_t value) noexcept {
    for (int i = 0; i < 8; ++i) add_byte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void add_byte(std::uint8_t byte) noexcept { hash_ = (hash_ ^ byte) * 0x100000001b3u; }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

std::uint64_t imprint(const Scene& scene, const Limits& limits, EngineKind kind) noexcept {
  Imprint of;
  for (const std::uint64_t value :
       {std::uint64_t{sizeof(Engine)}, std::uint64_t{sizeof(levels::Node)},
        std::uint64_t{limits.nodes}, std::uint64_t{limits.contacts}, std::uint64_t{limits.clusters},
        static_cast<std::uint64_t>(kind), std::uint64_t{scene.tool}}) {
    of.add(value);
  }
  for (const BodyPair& pair : scene.pairs) of.add((std::uint64_t{pair.a} << 32) | pair.b);
  for (const ImageView& body : scene.bodies) {
    for (const std::uint8_t byte : body.header->content_sha256) of.add_byte(byte);
  }
  return of.value();
}

Status check_memory(const Scene& scene, const Limits& limits, EngineKind kind,
                    std::span<const std::byte> memory) noexcept {
  if (memory.size() < required_bytes(scene, limits, kind) ||
      reinterpret_cast<std::uintptr_t>(memory.data()) % Arena::kAlignment != 0) {
    return Status::not_enough_memory;
  }
  return Status::ok;
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
    if (!serves(body, settings)) return Status::image_missing_section;
  }
  const Status room = check_memory(scene, limits, settings.engine, memory);
  if (room != Status::ok) return room;
  Arena arena(memory);
  Engine& engine = attach(lay_out(arena, scene, limits, settings.engine), scene);
  engine.made_for = imprint(scene, limits, settings.engine);
  engine.bodies = static_cast<std::uint32_t>(scene.bodies.size());
  engine.tool = scene.tool;
  engine.settings = settings;
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) begin(engine.states[i], scene.pairs[i]);
  if (settings.engine == EngineKind::levels) {
    begin_levels(engine.levels);
  } else {
    begin_regions(scene, engine.minima);
  }
  if (!all_fine_enough(engine, settings)) return Status::image_too_coarse;
  out_engine = &engine;
  return Status::ok;
}

Status restore(const Scene& scene, const Limits& limits, EngineKind kind,
               std::span<std::byte> memory, Engine*& out_engine) noexcept {
  if (!sound(scene, limits)) return Status::bad_argument;
  const Status room = check_memory(scene, limits, kind, memory);
  if (room != Status::ok) return room;
  Arena arena(memory, Arena::Contents::kept);
  const Layout layout = lay_out(arena, scene, limits, kind);
  if (layout.engine[0].made_for != imprint(scene, limits, kind)) return Status::bad_argument;
  out_engine = &attach(layout, scene);
  return Status::ok;
}

Status configure(Engine& engine, const Settings& settings) noexcept {
  if (!sound(settings) || settings.engine != engine.settings.engine) return Status::bad_argument;
  if (!all_fine_enough(engine, settings)) return Status::image_too_coarse;
  engine.settings = settings;
  return Status::ok;
}

}  // namespace palpate
