// SPDX-License-Identifier: GPL-3.0-or-later
// The exact force of both engines beside that of the contact oracle (docs/CONTACT.md) at random
// poses of two meshes.
//
//   compare_with_oracle A B [POSES [SEED]]      models of `palpate make-model`, or mesh files
//
// Both are scaled so that the smaller has radius 1; delta is 0.02. Body a comes from a random
// direction, turned at random, to a gap of delta up to an overlap of two. Where the meshes' own
// coordinates put them as near as that, every other pose is there, turned and moved at random by up
// to two delta.
//
// A line (CSV) for every pose and engine, `off` 1 where the force differs by more than 1 % of k
// delta plus 1 % of itself; then, for each engine, how many poses were felt and how many of them
// are off.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "tests/support/contact_oracle.hpp"
#include "tests/support/shapes.hpp"
#include "tools/bench/scenes.hpp"

namespace palpate::bench {
namespace {

constexpr double kDelta = 0.02;
constexpr double kFar = 5 * kDelta;
constexpr double kStiffness = 600;

class Poses {
 public:
  Poses(const Body& a, const Body& b, std::uint32_t seed)
      : a_(a),
        b_(b),
        wide_(a, b,
              {.engine = EngineKind::regions,
               .delta_m = kFar,
               .exact = true,
               .stiffness_N_per_m = 0}),
        rng_(seed) {
    const double distance = distance_at(wide_, {}, kFar);
    near_as_they_lie_ = distance > -2 * kDelta && distance < kFar;
  }

  Pose at(int i) { return near_as_they_lie_ && i % 2 == 1 ? where_they_lie() : from_outside(); }

 private:
  Pose from_outside() {
    const Vec3d out = direction();
    Pose pose;
    pose.orientation = turned(uniform(0, 3.1));
    const double apart = a_.view.header->radius_m + b_.view.header->radius_m;
    pose.position_m = centre_of(b_) + apart * out - rotation(pose.orientation) * centre_of(a_);
    constexpr double kTouching = 0.05 * kDelta;
    pose = brought_near(wide_, pose, out, kTouching, kFar);
    pose.position_m += uniform(-2, 1) * kDelta * out;
    return pose;
  }

  Pose where_they_lie() {
    Pose pose;
    pose.orientation = turned(uniform(0, 2 * kDelta / a_.view.header->radius_m));
    const Vec3d centre = centre_of(a_);
    pose.position_m =
        centre - rotation(pose.orientation) * centre + uniform(0, 2 * kDelta) * direction();
    return pose;
  }

  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(rng_);
  }
  Vec3d direction() {
    std::normal_distribution<double> g;
    const Vec3d v{g(rng_), g(rng_), g(rng_)};
    return (1 / norm(v)) * v;
  }
  Quat turned(double angle) {
    const Vec3d axis = std::sin(angle / 2) * direction();
    return {std::cos(angle / 2), axis.x, axis.y, axis.z};
  }

  const Body& a_;
  const Body& b_;
  Bench wide_;
  std::mt19937 rng_;
  bool near_as_they_lie_ = false;
};

struct Tally {
  int felt = 0;
  int off = 0;
};

void compare(const char* name_a, const char* name_b, int poses, std::uint32_t seed) {
  const bake::Mesh mesh_a = mesh_of(name_a), mesh_b = mesh_of(name_b);
  const double factor = 1 / std::min(bake::radius_of(mesh_a), bake::radius_of(mesh_b));
  const Body a(test::scaled(mesh_a, factor), kDelta, bake::ForEngine::both);
  const Body b(test::scaled(mesh_b, factor), kDelta, bake::ForEngine::both);
  const test::OracleSurface surface_a(a.view), surface_b(b.view);
  Settings settings{
      .delta_m = kDelta, .exact = true, .stiffness_N_per_m = kStiffness, .cluster_radius_m = 0};
  const Limits limits{.nodes = 1u << 21, .contacts = 1u << 21, .clusters = 1u << 15};
  settings.engine = EngineKind::regions;
  Bench regions(a, b, settings, limits);
  settings.engine = EngineKind::levels;
  Bench levels(a, b, settings, limits);
  struct Engine {
    const char* name;
    Bench& bench;
    Tally tally;
  } engines[] = {{"regions", regions, {}}, {"levels", levels, {}}};
  Poses random(a, b, seed);
  std::printf("pose,engine,off,oracle_N,off_N,off_Nm,px,py,pz,qw,qx,qy,qz\n");
  for (int i = 0; i < poses; ++i) {
    const Pose pose = random.at(i);
    const Wrench truth = test::contact_oracle(surface_a, pose, surface_b, {}, kDelta, kStiffness);
    const double size = norm(truth.force_N);
    for (Engine& engine : engines) {
      const Wrench w = engine.bench.tick_at(pose).wrench;
      const double off = norm(w.force_N - truth.force_N);
      if (size > 0 || norm(w.force_N) > 0) ++engine.tally.felt;
      const bool is_off = off > 0.01 * (kStiffness * kDelta + size);
      engine.tally.off += is_off ? 1 : 0;
      const Vec3d p = pose.position_m;
      const Quat q = pose.orientation;
      std::printf("%d,%s,%d,%.6g,%.3g,%.3g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", i,
                  engine.name, is_off ? 1 : 0, size, off, norm(w.torque_Nm - truth.torque_Nm), p.x,
                  p.y, p.z, q.w, q.x, q.y, q.z);
      std::fflush(stdout);
    }
  }
  for (const Engine& engine : engines) {
    std::printf("# %s and %s, %s: %d poses, %d felt, %d off\n", name_a, name_b, engine.name, poses,
                engine.tally.felt, engine.tally.off);
  }
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "compare_with_oracle A B [POSES [SEED]]\n");
    return 2;
  }
  const int poses = argc > 3 ? std::atoi(argv[3]) : 1000;
  const auto seed = static_cast<std::uint32_t>(argc > 4 ? std::atoi(argv[4]) : 1);
  palpate::bench::compare(argv[1], argv[2], poses, seed);
}
