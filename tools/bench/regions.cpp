// SPDX-License-Identifier: GPL-3.0-or-later
// Time and accuracy of the region engine on scenes of two detailed objects.
//
//   bench_regions [TICKS [SCENE...]]     scenes: jaws, golf, socket, screw, joint; default: all
//
// A row (CSV) for each scene, contact tolerance (1, 2, 5 % of the radius) and mode: exact with all
// state kept (warm) or forgotten at each tick (cold), and under budgets of time. Times are of the
// thread's own processor clock, so that a busy machine shows in the caches only. force_nrmse is
// against the exact ticks, of their largest force, over all ticks but the first ten;
// bound_of_force is the median of the certified error over that force; force_step is the largest
// change of force from tick to tick.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "host_bake/bake.hpp"
#include "host_bake/mesh/check.hpp"
#include "host_bake/models/models.hpp"
#include "host_bake/pack/aligned.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate {
namespace {

constexpr int kSettled = 10;  // ticks after which a budgeted run counts
constexpr Limits kLimits{};

std::uint64_t processor_ns(void* = nullptr) {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000 +
         static_cast<std::uint64_t>(t.tv_nsec);
}

struct SceneName {
  const char* name;
  const char* a;
  const char* b;
  bool interlock;  ///< as modelled they interlock with a small clearance
};
constexpr SceneName kScenes[] = {{"jaws", "jaw_lower", "jaw_upper", true},
                                 {"golf", "golf_ball", "golf_ball", false},
                                 {"socket", "golf_ball", "golf_shell", true},
                                 {"screw", "screw", "nut", true},
                                 {"joint", "ball_joint_head", "ball_joint_cup", true}};

struct Body {
  Body(const char* model, double delta_rel) {
    const bake::Mesh mesh = bake::make_model(model);
    bake::BakeOptions options;
    options.engine = bake::ForEngine::regions;
    options.delta_rel = delta_rel;
    bake::BakeReport report;
    image = std::make_unique<bake::AlignedCopy>(
        bake::bake(mesh, bake::check(mesh), options, {}, report));
    if (validate(image->bytes(), view) != Status::ok) std::abort();
  }
  std::unique_ptr<bake::AlignedCopy> image;
  ImageView view;
};

/// An engine over two bodies that can forget all it knows.
class Bench {
 public:
  Bench(const Body& a, const Body& b, double delta_m) : views_{a.view, b.view} {
    settings_.engine = EngineKind::regions;
    settings_.delta_m = delta_m;
    bytes_ = required_bytes(scene(), kLimits, EngineKind::regions);
    memory_.reset(new (std::align_val_t(64)) std::byte[bytes_]);
    forget();
  }
  void forget() {
    if (create(scene(), settings_, kLimits, {memory_.get(), bytes_}, engine_) != Status::ok) {
      std::abort();
    }
  }
  /// Of all regions: what clusters make of them is the force stage's affair, and neighbours whose
  /// nearest point is a common one join a cluster or not by the last bit.
  [[nodiscard]] Vec3d force_N(const TickResult& r) const {
    Vec3d sum{};
    for (const Contact& c : r.contacts) {
      sum += (settings_.stiffness_N_per_m * (settings_.delta_m - c.distance_m)) * c.normal;
    }
    return sum;
  }
  TickResult tick_at(const Pose& pose, double budget_us = 0) {
    const Pose poses[2] = {pose, {}};
    Budget budget;
    if (budget_us > 0) {
      budget.clock_ns = processor_ns;
      budget.deadline_ns = processor_ns() + static_cast<std::uint64_t>(budget_us * 1e3);
    }
    TickResult result;
    if (tick(*engine_, poses, budget, result) != Status::ok) std::abort();
    return result;
  }

 private:
  struct Free {
    void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  [[nodiscard]] Scene scene() const { return {views_, pairs_, 0}; }

  std::vector<ImageView> views_;
  std::vector<BodyPair> pairs_{{0, 1}};
  Settings settings_;
  std::size_t bytes_ = 0;
  std::unique_ptr<std::byte[], Free> memory_;
  Engine* engine_ = nullptr;
};

Vec3d centre_of(const Body& body) {
  const double* c = body.view.header->centre_m;
  return {c[0], c[1], c[2]};
}

Quat turned(double x, double y, double z) {
  const double n = std::sqrt(1 + x * x + y * y + z * z);
  return {1 / n, x / n, y / n, z / n};
}

/// Distance at a pose, or `most`.
double distance_at(Bench& wide, const Pose& pose, double most) {
  const TickResult r = wide.tick_at(pose);
  return r.contacts.empty() ? most : r.min_distance_m;
}

/// Slides over the other body at a distance of about 0.4 delta.
Pose sliding(Bench& wide, const Body& a, const Body& b, double delta, double reach, int i) {
  const double u = 0.0035 * i;
  const double height = std::sin(0.3 * u);
  const Vec3d out{std::cos(u) * std::cos(0.3 * u), std::sin(u) * std::cos(0.3 * u), height};
  Pose pose{{}, turned(0.3 * std::sin(0.5 * u), 0.5 * u, 0.2 * u)};
  const double apart = a.view.header->radius_m + b.view.header->radius_m;
  pose.position_m = centre_of(b) + apart * out - rotation(pose.orientation) * centre_of(a);
  for (int k = 0; k < 40; ++k) {
    const double step = distance_at(wide, pose, reach) - 0.4 * delta;
    pose.position_m -= step * out;
    if (std::abs(step) < 1e-3 * delta) break;
  }
  return pose;
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

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

struct Run {
  std::vector<double> us, contacts, near, bound_N;
  std::vector<Vec3d> force_N;
};

Run run(Bench& bench, const std::vector<Pose>& poses, bool cold, double budget_us) {
  Run out;
  bench.forget();
  for (const Pose& pose : poses) {
    if (cold) bench.forget();
    const std::uint64_t start = processor_ns();
    const TickResult r = bench.tick_at(pose, budget_us);
    out.us.push_back(static_cast<double>(processor_ns() - start) * 1e-3);
    out.contacts.push_back(static_cast<double>(r.contacts.size()));
    out.near.push_back(static_cast<double>(r.front_nodes));
    out.bound_N.push_back(r.certificate.force_bound_N);
    out.force_N.push_back(bench.force_N(r));
  }
  return out;
}

double nrmse(const std::vector<Vec3d>& forces, const std::vector<Vec3d>& truth, double peak) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = kSettled; i < forces.size(); ++i, ++count) {
    sum += squared_norm(forces[i] - truth[i]);
  }
  return count > 0 && peak > 0 ? std::sqrt(sum / count) / peak : 0;
}

void print_row(const char* scene, double delta_rel, const char* mode, double budget_us,
               const Run& r, const Run& exact) {
  double peak = 0;
  double step = 0;
  for (std::size_t i = 0; i < exact.force_N.size(); ++i) {
    peak = std::max(peak, norm(exact.force_N[i]));
    if (i > 0) step = std::max(step, norm(exact.force_N[i] - exact.force_N[i - 1]));
  }
  std::printf("%s,%g,%s,%g,%.1f,%.1f,%.1f,%.1f,%.1f,%.4f,%.4f,%.4f\n", scene, delta_rel, mode,
              budget_us, mean(r.us), percentile(r.us, 0.5), percentile(r.us, 0.99), mean(r.near),
              mean(r.contacts), nrmse(r.force_N, exact.force_N, peak),
              percentile(r.bound_N, 0.5) / peak, step / peak);
  std::fflush(stdout);
}

void measure(const SceneName& scene, double delta_rel, int ticks) {
  const Body a(scene.a, delta_rel);
  const Body b(scene.b, delta_rel);
  const double radius = std::min(a.view.header->radius_m, b.view.header->radius_m);
  const double delta = delta_rel * radius;
  const double reach = scene.interlock ? delta : 0.3 * radius;
  Bench wide(a, b, reach);
  std::vector<Pose> poses;
  for (int i = 0; i < ticks; ++i) {
    poses.push_back(scene.interlock ? pressed(wide, a, delta, i)
                                    : sliding(wide, a, b, delta, reach, i));
  }
  Bench bench(a, b, delta);
  const Run exact = run(bench, poses, false, 0);
  print_row(scene.name, delta_rel, "warm", 0, exact, exact);
  print_row(scene.name, delta_rel, "cold", 0, run(bench, poses, true, 0), exact);
  for (const double budget_us : {50.0, 100.0, 250.0, 500.0}) {
    print_row(scene.name, delta_rel, "warm", budget_us, run(bench, poses, false, budget_us), exact);
    print_row(scene.name, delta_rel, "cold", budget_us, run(bench, poses, true, budget_us), exact);
  }
}

bool wanted(const SceneName& scene, int argc, char** argv) {
  for (int i = 2; i < argc; ++i) {
    if (std::strcmp(argv[i], scene.name) == 0) return true;
  }
  return argc <= 2;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::max(20, std::atoi(argv[1])) : 300;
  std::printf(
      "scene,delta_rel,mode,budget_us,mean_us,median_us,p99_us,near_regions,contacts,force_nrmse,"
      "bound_of_force,force_step\n");
  for (const palpate::SceneName& scene : palpate::kScenes) {
    if (!palpate::wanted(scene, argc, argv)) continue;
    for (const double delta_rel : {0.01, 0.02, 0.05}) palpate::measure(scene, delta_rel, ticks);
  }
  return 0;
}
