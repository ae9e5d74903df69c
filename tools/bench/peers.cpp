// SPDX-License-Identifier: GPL-3.0-or-later
// Palpate beside FCL and, where it is installed, Bullet: same meshes, same poses, same run.
//
//   bench_peers SCENE.toml POSES.csv TOOL_MESH OTHER_MESH [TICKS]
//
// A row (CSV) for each query: what it returns, its time, how many results, and how far its least
// distance is from FCL's, over ticks where the surfaces are apart and nearer than delta. Every
// query runs over all poses three times, in turns with the others, and each tick has its median.
// Times are of the thread's own processor clock, so that a busy machine shows in the caches only.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "host_bake/mesh/read.hpp"
#ifdef PALPATE_BENCH_BULLET
#include "tools/bench/mesh_bullet.hpp"
#endif
#include "tools/bench/mesh_fcl.hpp"
#include "tools/palpate/clocks.hpp"
#include "tools/palpate/poses.hpp"
#include "tools/palpate/scene_engine.hpp"
#include "tools/palpate/sweep_figures.hpp"
#include "tools/palpate/sweep_settings.hpp"

namespace palpate::bench {
namespace {

constexpr int kPasses = 3;
constexpr std::size_t kMostCrossings = 100'000;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Answer {
  double distance_m = kNone;  ///< NaN: none below delta, or not what this query tells
  std::size_t results = 0;
};

struct Query {
  std::string name, returns;
  std::function<void()> restart;
  std::function<Answer(std::span<const Pose>)> ask;
  std::vector<std::vector<double>> us;  ///< [ticks][passes]
  std::vector<Answer> answers;          ///< [ticks], of the last pass
};

void run(Query& query, const cli::PoseTrack& track, std::vector<Pose> poses) {
  query.restart();
  query.us.resize(track.ticks.size());
  query.answers.resize(track.ticks.size());
  for (std::size_t i = 0; i < track.ticks.size(); ++i) {
    track.apply(i, poses);
    const std::uint64_t start = cli::processor_ns();
    query.answers[i] = query.ask(poses);
    query.us[i].push_back(static_cast<double>(cli::processor_ns() - start) * 1e-3);
  }
}

/// A Palpate engine at one setting; the scene lives as long as the query does.
Query palpate_query(const config::Scene& scene, const cli::SweepSetting& setting, const char* name,
                    const char* returns) {
  struct Held {
    explicit Held(config::Scene s) : scene(std::move(s)), engine(scene) {}
    config::Scene scene;
    cli::SceneEngine engine;
  };
  const auto held = std::make_shared<Held>(cli::with_setting(scene, setting));
  Query q{name, returns, {}, {}, {}, {}};
  q.restart = [held] { held->engine.restart(); };
  q.ask = [held](std::span<const Pose> poses) {
    TickResult result;
    if (tick(held->engine.engine(), poses, {}, result) != Status::ok) std::abort();
    return Answer{result.min_distance_m, result.contacts.size()};
  };
  return q;
}

void add_fcl(const std::shared_ptr<FclPair>& pair, std::uint32_t tool, std::vector<Query>& out) {
  const std::size_t a = tool, b = 1 - a;
  const auto nothing = [] {};
  out.push_back({"fcl distance OBBRSS",
                 "one least distance",
                 nothing,
                 [=](std::span<const Pose> poses) {
                   return Answer{pair->distance(poses[a], poses[b]), 1};
                 },
                 {},
                 {}});
  out.push_back({"fcl collide OBBRSS",
                 "crossing triangles; nothing of gaps",
                 nothing,
                 [=](std::span<const Pose> poses) {
                   return Answer{kNone, pair->crossings(poses[a], poses[b], kMostCrossings)};
                 },
                 {},
                 {}});
}

#ifdef PALPATE_BENCH_BULLET
void add_bullet(const std::shared_ptr<BulletPair>& pair, std::uint32_t tool,
                std::vector<Query>& out) {
  const std::size_t a = tool, b = 1 - a;
  out.push_back({"bullet GImpact",
                 "contacts of triangles nearer than delta; no wrench",
                 [] {},
                 [=](std::span<const Pose> poses) {
                   const BulletContacts found = pair->contacts(poses[a], poses[b]);
                   return Answer{found.least_distance_m, found.count};
                 },
                 {},
                 {}});
}
#endif

void add_palpate(const config::Scene& scene, std::vector<Query>& out) {
  const double delta_m = scene.settings.delta_m;
  const double touch_N = scene.settings.stiffness_N_per_m * delta_m;
  using enum EngineKind;
  out.push_back(palpate_query(scene, {.engine = regions, .exact = true, .delta_m = delta_m},
                              "palpate regions exact",
                              "a contact for each region nearer than delta; wrench"));
  out.push_back(palpate_query(scene,
                              {.engine = regions, .force_tolerance_N = touch_N, .delta_m = delta_m},
                              "palpate regions to the force at touch",
                              "the same within a certified error of force; wrench"));
  out.push_back(palpate_query(scene, {.exact = true, .delta_m = delta_m}, "palpate levels exact",
                              "all pairs of pieces nearer than delta; wrench"));
  out.push_back(palpate_query(scene, {.s0 = 0.025, .delta_m = delta_m}, "palpate levels s0 2.5 %",
                              "the same without detail below s0; wrench"));
}

void print_row(const Query& query, const Query& truth, double delta_m) {
  std::vector<double> us;
  double results = 0, worst_m = kNone;
  for (std::size_t i = 0; i < query.us.size(); ++i) {
    us.push_back(cli::percentile(query.us[i], 0.5));
    results += static_cast<double>(query.answers[i].results);
    const double true_m = truth.answers[i].distance_m;
    const double off_m = std::abs(query.answers[i].distance_m - true_m);
    if (true_m > 0 && true_m < delta_m && !std::isnan(off_m)) worst_m = std::fmax(worst_m, off_m);
  }
  std::printf("%s,%s,%.1f,%.1f,%.1f,%.1f,", query.name.c_str(), query.returns.c_str(),
              cli::percentile(us, 0.5), cli::percentile(us, 0.99), cli::percentile(us, 1.0),
              results / static_cast<double>(us.size()));
  if (!std::isnan(worst_m)) std::printf("%.3g", worst_m);
  std::puts("");
}

bake::Mesh mesh_of(const char* file) { return bake::read_mesh(file).mesh; }

void compare(int argc, char** argv) {
  const config::Scene scene = config::load_scene(argv[1]);
  cli::PoseTrack track = cli::read_poses(argv[2], scene);
  if (argc > 5) {
    const auto ticks = static_cast<std::size_t>(std::max(1, std::atoi(argv[5])));
    track.ticks.resize(std::min(ticks, track.ticks.size()));
  }
  std::vector<Pose> poses;
  for (const config::Body& body : scene.bodies) poses.push_back(body.pose);
  std::vector<Query> queries;
  const bake::Mesh tool = mesh_of(argv[3]), other = mesh_of(argv[4]);
  add_fcl(std::make_shared<FclPair>(tool, other), scene.tool, queries);
#ifdef PALPATE_BENCH_BULLET
  add_bullet(std::make_shared<BulletPair>(tool, other, scene.settings.delta_m), scene.tool,
             queries);
#endif
  add_palpate(scene, queries);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (Query& query : queries) run(query, track, poses);
  }
  std::puts("query,returns,median_us,p99_us,max_us,results_mean,distance_off_max_m");
  for (const Query& query : queries) print_row(query, queries.front(), scene.settings.delta_m);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("usage: bench_peers SCENE.toml POSES.csv TOOL_MESH OTHER_MESH [TICKS]\n", stderr);
    return 2;
  }
  try {
    palpate::bench::compare(argc, argv);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_peers: error: %s\n", e.what());
    return 1;
  }
}
