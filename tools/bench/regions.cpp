// SPDX-License-Identifier: GPL-3.0-or-later
// Time of certified distances (rt_core/regions/minima.hpp) on scenes of two detailed objects.
//
//   bench_regions [TICKS [SCENE[:DELTA]...]]   scenes: jaws, tips, golf, socket, screw, joint,
//   gears;
//                                              default: all, with 0.01, 0.02 and 0.05
//   bench_regions TICKS instructions           jaws by each instruction set of this processor
//
// The least distance of every region of A from B, exactly, no force asked (stiffness 0). A row
// (CSV) for each scene, contact tolerance (relative to the radius) and mode: with all state kept
// (warm) or forgotten at each tick (cold). Times are of the thread's own processor clock, so that a
// busy machine shows in the caches only; units are those of the engine (TickResult::queries),
// counted and not timed. Where FCL is installed, its distance of the same meshes (one least
// distance, OBBRSS) is asked between the warm ticks, pose by pose; of_fcl is our time by its time,
// summed over the run.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/scenes.hpp"
#if defined(PALPATE_BENCH_FCL)
#include "tools/bench/mesh_fcl.hpp"
#endif
#include "tools/palpate/clocks.hpp"

namespace palpate::bench {
namespace {

constexpr SceneName kScenes[] = {
    {"jaws", "jaw_lower", "jaw_upper", true},  {"tips", "jaw_lower", "jaw_lower", false, true},
    {"golf", "golf_ball", "golf_ball", false}, {"socket", "golf_ball", "golf_shell", true},
    {"screw", "screw", "nut", true},           {"joint", "ball_joint_head", "ball_joint_cup", true},
    {"gears", "gear_60", "gear_50", false}};

/// What is asked between two ticks.
#if defined(PALPATE_BENCH_FCL)
using Peer = FclPair;
double peer_us(const Peer& peer, const Pose& pose) {
  const std::uint64_t start = cli::processor_ns();
  const double distance = peer.distance(pose, {});
  const double us = static_cast<double>(cli::processor_ns() - start) * 1e-3;
  return distance >= 0 ? us : 0;
}
#else
struct Peer {
  Peer(const bake::Mesh&, const bake::Mesh&) {}
};
double peer_us(const Peer&, const Pose&) { return 0; }
#endif

struct Run {
  std::vector<double> us, units, near, contacts;
  double fcl_us = 0;  ///< mean; 0: not asked
};

Run run(Bench& bench, const std::vector<Pose>& poses, bool cold, const Peer* peer = nullptr) {
  Run out;
  bench.forget();
  for (const Pose& pose : poses) {
    if (cold) bench.forget();
    const std::uint64_t start = cli::processor_ns();
    const TickResult r = bench.tick_at(pose, {});
    out.us.push_back(static_cast<double>(cli::processor_ns() - start) * 1e-3);
    out.units.push_back(static_cast<double>(r.queries));
    out.near.push_back(static_cast<double>(r.front_nodes));
    out.contacts.push_back(static_cast<double>(r.contacts.size()));
    if (peer != nullptr) out.fcl_us += peer_us(*peer, pose) / static_cast<double>(poses.size());
  }
  return out;
}

void print_row(const char* scene, double delta_rel, const char* mode, const Run& r) {
  std::printf("%s,%g,%s,%.1f,%.1f,%.1f,%.1f,%.0f,%.1f,%.1f", scene, delta_rel, mode, mean(r.us),
              percentile(r.us, 0.5), percentile(r.us, 0.99), percentile(r.us, 1), mean(r.units),
              mean(r.near), mean(r.contacts));
  if (r.fcl_us > 0) {
    std::printf(",%.1f,%.3f\n", r.fcl_us, mean(r.us) / r.fcl_us);
  } else {
    std::printf(",,\n");
  }
  std::fflush(stdout);
}

/// Two bodies and their motion.
struct Staged {
  Staged(const SceneName& scene, double delta_rel, int ticks)
      : a(scene.a, delta_rel, bake::ForEngine::regions),
        b(scene.b, delta_rel, bake::ForEngine::regions),
        delta(delta_rel * std::min(a.view.header->radius_m, b.view.header->radius_m)),
        poses(motion(scene, a, b, delta, ticks)) {}

  Settings settings() const {
    return {.engine = EngineKind::regions, .delta_m = delta, .exact = true, .stiffness_N_per_m = 0};
  }

  Body a, b;
  double delta;
  std::vector<Pose> poses;
};

void measure(const SceneName& scene, double delta_rel, int ticks) {
  const Staged staged(scene, delta_rel, ticks);
  const Peer peer(mesh_of(scene.a), mesh_of(scene.b));
  Bench bench(staged.a, staged.b, staged.settings());
  print_row(scene.name, delta_rel, "warm", run(bench, staged.poses, false, &peer));
  print_row(scene.name, delta_rel, "cold", run(bench, staged.poses, true));
}

/// By each table of kernels that runs here, narrowest first, turn by turn.
void measure_instructions(int ticks) {
  constexpr double kDeltaRel = 0.02;
  constexpr int kTurns = 5;
  const Staged jaws(kScenes[0], kDeltaRel, ticks);
  const regions::Kernels* tables[regions::kMostKernels] = {};
  const std::uint32_t count = regions::all_kernels(tables);
  Bench bench(jaws.a, jaws.b, jaws.settings());
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::uint32_t i = 0; i < count; ++i) {
      bench.use(*tables[i]);
      print_row(tables[i]->name, kDeltaRel, "warm", run(bench, jaws.poses, false));
      print_row(tables[i]->name, kDeltaRel, "cold", run(bench, jaws.poses, true));
    }
  }
}

/// What an argument asks of a scene: a tolerance, or 0 for all; nothing where it names another.
std::optional<double> asked(const SceneName& scene, const char* argument) {
  const std::size_t length = std::strlen(scene.name);
  if (std::strncmp(argument, scene.name, length) != 0) return std::nullopt;
  if (argument[length] == '\0') return 0;
  if (argument[length] != ':') return std::nullopt;
  return std::atof(argument + length + 1);
}

void measure_asked(const SceneName& scene, double delta_rel, int ticks) {
  if (delta_rel > 0) {
    measure(scene, delta_rel, ticks);
    return;
  }
  for (const double each : {0.01, 0.02, 0.05}) measure(scene, each, ticks);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate::bench;
  const int ticks = argc > 1 ? std::max(20, std::atoi(argv[1])) : 300;
  std::printf(
      "scene,delta_rel,mode,mean_us,median_us,p99_us,most_us,units,near_regions,contacts,fcl_us,"
      "of_fcl\n");
  if (argc > 2 && std::strcmp(argv[2], "instructions") == 0) {
    measure_instructions(ticks);
    return 0;
  }
  for (const SceneName& scene : kScenes) {
    if (argc <= 2) measure_asked(scene, 0, ticks);
    for (int i = 2; i < argc; ++i) {
      if (const auto what = asked(scene, argv[i])) measure_asked(scene, *what, ticks);
    }
  }
  return 0;
}
