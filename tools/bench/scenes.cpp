// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>

#include "host_bake/mesh/check.hpp"
#include "host_bake/mesh/read.hpp"
#include "host_bake/models/models.hpp"
#include "rt_core/engine.hpp"

namespace palpate::bench {
namespace {

constexpr double kSlidingGap = 0.4;  // of delta

/// More than any scene needs; for regions, eight grid points for each contact that there can be.
Limits limits_of(EngineKind engine, const ImageView& tool) {
  if (engine == EngineKind::levels) {
    return {.nodes = 1u << 19, .contacts = 1u << 18, .clusters = 1u << 15};
  }
  const auto regions = static_cast<std::uint32_t>(tool.regions.size());
  return {.nodes = 1, .clusters = std::max(1u << 14, 8 * regions)};
}

/// A spur gear as CAD programs export it: every strip of a flank is two needles, as long as the
/// gear is thick, and its faces are fans. About z; radius 1 m at half the height of its teeth.
bake::Mesh spur_gear(std::uint32_t teeth) {
  constexpr std::uint32_t kStripsOfTooth = 8;
  constexpr double kHalfHeight = 0.08;
  constexpr double kHalfThickness = 0.5;
  const std::uint32_t strips = kStripsOfTooth * teeth;
  const std::uint32_t hub = 2 * strips;
  bake::Mesh mesh;
  for (std::uint32_t k = 0; k < strips; ++k) {
    const double angle = 2 * std::numbers::pi * k / strips;
    const double radius = 1 + kHalfHeight * std::cos(teeth * angle);
    const double x = radius * std::cos(angle);
    const double y = radius * std::sin(angle);
    mesh.points.insert(mesh.points.end(), {{x, y, -kHalfThickness}, {x, y, kHalfThickness}});
    const std::uint32_t low = 2 * k;
    const std::uint32_t next = 2 * ((k + 1) % strips);
    mesh.faces.insert(mesh.faces.end(), {{low, next, next + 1},
                                         {low, next + 1, low + 1},
                                         {hub, next, low},
                                         {hub + 1, low + 1, next + 1}});
  }
  mesh.points.insert(mesh.points.end(), {{0, 0, -kHalfThickness}, {0, 0, kHalfThickness}});
  return mesh;
}

Quat turned(double x, double y, double z) {
  const double n = std::sqrt(1 + x * x + y * y + z * z);
  return {1 / n, x / n, y / n, z / n};
}

Pose sliding(Bench& wide, const Body& a, const Body& b, double delta, double reach, int i) {
  const double u = 0.0035 * i;
  const double height = std::sin(0.3 * u);
  const Vec3d out{std::cos(u) * std::cos(0.3 * u), std::sin(u) * std::cos(0.3 * u), height};
  Pose pose{{}, turned(0.3 * std::sin(0.5 * u), 0.5 * u, 0.2 * u)};
  const double apart = a.view.header->radius_m + b.view.header->radius_m;
  pose.position_m = centre_of(b) + apart * out - rotation(pose.orientation) * centre_of(a);
  return brought_near(wide, pose, out, kSlidingGap * delta, reach);
}

/// Half a turn about y, small turns and shifts, then down.
Pose upon_tips(Bench& wide, const Body& a, const Body& b, double delta, double reach, int i) {
  const double u = 0.0035 * i;
  const double radius = b.view.header->radius_m;
  const Quat small = turned(0.02 * std::sin(2 * u), 0.02 * std::sin(3 * u), 0.03 * std::sin(u));
  Pose pose{{}, {-small.y, -small.z, small.w, small.x}};
  pose.position_m = centre_of(b) - rotation(pose.orientation) * centre_of(a) +
                    radius * Vec3d{0.15 * std::sin(u), 0.15 * std::sin(1.7 * u + 1), 1.2};
  return brought_near(wide, pose, {0, 0, 1}, kSlidingGap * delta, reach);
}

/// Small turns where it lies, pressed in a turning direction until about 0.1 delta is left.
Pose pressed(Bench& wide, const Body& a, double delta, int i) {
  const double u = 0.0035 * i;
  const Vec3d to{0.7 * std::cos(7 * u), 0.7 * std::sin(7 * u), std::cos(2 * u)};
  Pose pose{{},
            turned(8e-4 * std::sin(2 * u), 6e-4 * std::sin(3 * u + 1), 1e-3 * std::sin(1.3 * u))};
  pose.position_m = centre_of(a) - rotation(pose.orientation) * centre_of(a);
  double step = 0.3 * delta / norm(to);
  for (int k = 0; k < 14; ++k) {
    Pose next = pose;
    next.position_m += step * to;
    if (distance_at(wide, next, delta) > 0.1 * delta) {
      pose = next;
    } else {
      step *= 0.5;
    }
  }
  return pose;
}

}  // namespace

bake::Mesh mesh_of(std::string_view model, std::size_t triangles) {
  if (model == "gear_60") return spur_gear(60);
  if (model == "gear_50") return spur_gear(50);
  if (model.find('.') != std::string_view::npos) return bake::read_mesh(model).mesh;
  return bake::make_model(model, triangles);
}

Body::Body(const char* model, double delta_rel, bake::ForEngine engine, std::size_t triangles,
           double max_deviation)
    : Body(mesh_of(model, triangles), delta_rel, engine, max_deviation) {}

Body::Body(const bake::Mesh& mesh, double delta_rel, bake::ForEngine engine, double max_deviation) {
  bake::BakeOptions options;
  options.engine = engine;
  options.delta_rel = delta_rel;
  options.max_deviation_rel = max_deviation;
  bake::BakeReport report;
  image =
      std::make_unique<bake::AlignedCopy>(bake::bake(mesh, bake::check(mesh), options, {}, report));
  if (validate(image->bytes(), view) != Status::ok) std::abort();
}

Vec3d centre_of(const Body& body) {
  const double* c = body.view.header->centre_m;
  return {c[0], c[1], c[2]};
}

Bench::Bench(const Body& a, const Body& b, const Settings& settings)
    : Bench(a, b, settings, limits_of(settings.engine, a.view)) {}

Bench::Bench(const Body& a, const Body& b, const Settings& settings, const Limits& limits)
    : views_{a.view, b.view}, settings_(settings), limits_(limits) {
  bytes_ = required_bytes(scene(), limits_, settings_.engine);
  memory_.reset(new (std::align_val_t(64)) std::byte[bytes_]);
  forget();
}

void Bench::forget() {
  if (create(scene(), settings_, limits_, {memory_.get(), bytes_}, engine_) != Status::ok) {
    std::abort();
  }
  if (kernels_ != nullptr) engine_->search.kernels = engine_->minima.kernels = kernels_;
}

void Bench::use(const regions::Kernels& kernels) {
  kernels_ = &kernels;
  forget();
}

TickResult Bench::tick_at(const Pose& pose, const Budget& budget) {
  const Pose poses[2] = {pose, {}};
  TickResult result;
  if (tick(*engine_, poses, budget, result) != Status::ok) std::abort();
  if (result.certificate.truncated_by_memory) std::abort();
  return result;
}

void Bench::save(std::vector<std::byte>& state) const {
  state.assign(memory_.get(), memory_.get() + bytes_);
}

void Bench::restore(const std::vector<std::byte>& state) {
  std::copy(state.begin(), state.end(), memory_.get());
}

std::vector<Pose> motion(const SceneName& scene, const Body& a, const Body& b, double delta_m,
                         int ticks) {
  const double radius = std::min(a.view.header->radius_m, b.view.header->radius_m);
  const double reach = scene.interlock ? delta_m : 0.3 * radius;
  Bench wide(
      a, b,
      {.engine = EngineKind::regions, .delta_m = reach, .exact = true, .stiffness_N_per_m = 0});
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; ++i) {
    poses.push_back(scene.interlock     ? pressed(wide, a, delta_m, i)
                    : scene.upside_down ? upon_tips(wide, a, b, delta_m, reach, i)
                                        : sliding(wide, a, b, delta_m, reach, i));
  }
  return poses;
}

double distance_at(Bench& wide, const Pose& pose, double most) {
  const TickResult r = wide.tick_at(pose);
  return r.contacts.empty() ? most : r.min_distance_m;
}

Pose brought_near(Bench& wide, Pose pose, Vec3d out, double gap_m, double reach_m) {
  for (int k = 0; k < 60; ++k) {
    const double step = distance_at(wide, pose, reach_m) - gap_m;
    pose.position_m -= step * out;
    if (std::abs(step) < 2.5e-3 * gap_m) break;
  }
  return pose;
}

double nrmse(const std::vector<Vec3d>& forces, const std::vector<Vec3d>& truth, std::size_t first) {
  double peak = 0;
  for (const Vec3d& force : truth) peak = std::max(peak, norm(force));
  double sum = 0;
  for (std::size_t i = first; i < forces.size(); ++i) sum += squared_norm(forces[i] - truth[i]);
  if (forces.size() <= first || peak == 0) return 0;
  return std::sqrt(sum / static_cast<double>(forces.size() - first)) / peak;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace palpate::bench
