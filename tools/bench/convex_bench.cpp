// SPDX-License-Identifier: GPL-3.0-or-later
// Distance of convex pairs by size, warm and cold, with FCL's libccd beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/convex/distance.hpp"
#include "tools/bench/convex_motions.hpp"
#include "tools/bench/stopwatch.hpp"
#ifdef PALPATE_BENCH_FCL
#include "tools/bench/convex_fcl.hpp"
#endif

namespace palpate::bench {
namespace {

constexpr std::uint32_t kPairs = 20;
constexpr std::uint32_t kSteps = 1000;
/// Each query is timed once a pass; its time is the undisturbed_mean() of them.
constexpr std::uint32_t kPasses = 32;
constexpr std::uint32_t kSizes[] = {12, 16, 24, 32, 48, 64, 100, 500};

struct Case {
  std::uint32_t vertices;
  Coherence coherence;
  convex::Hull (BenchHull::*hull)() const;
};

/// Ticks of every query in every pass.
class Times {
 public:
  /// Of the query that ran since the reading `last`. Returns the reading now.
  std::uint64_t add(std::size_t query, std::uint64_t last) {
    const std::uint64_t now = read_ticks();
    ticks_[query * kPasses + pass_] = static_cast<std::uint32_t>(now - last);
    return now;
  }
  void end_pass() { ++pass_; }

  void report(benchmark::State& state) {
    static const Stopwatch stopwatch = calibrated();
    std::vector<double> ns;
    for (std::size_t query = 0; query < kPairs * kSteps; ++query) {
      ns.push_back(stopwatch.ns(undisturbed_mean({&ticks_[query * kPasses], kPasses})));
    }
    std::sort(ns.begin(), ns.end());
    state.counters["median_ns"] = ns[ns.size() / 2];
    state.counters["p99_ns"] = ns[ns.size() * 99 / 100];
    state.counters["max_ns"] = ns.back();
  }

 private:
  std::size_t pass_ = 0;
  std::vector<std::uint32_t> ticks_ =
      std::vector<std::uint32_t>(std::size_t{kPairs} * kSteps * kPasses);
};

void measure_palpate(benchmark::State& state, const Case& what) {
  const std::vector<Motion> motions = make_motions(what.vertices, what.coherence, kPairs, kSteps);
  Times times;
  std::vector<convex::Distance> answers(kPairs * kSteps);
  for ([[maybe_unused]] const auto pass : state) {
    std::size_t query = 0;
    for (const Motion& motion : motions) {
      const convex::Hull a = (motion.a.*what.hull)();
      const convex::Hull b = (motion.b.*what.hull)();
      convex::Cache cache;
      std::uint64_t last = read_ticks();
      for (const RelativePose& pose : motion.poses) {
        answers[query] = convex::distance(a, b, pose, {}, cache);
        last = times.add(query++, last);
      }
    }
    times.end_pass();
  }
  double worst = 0;
  std::uint64_t iterations = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Motion& motion = motions[i / kSteps];
    const convex::Distance& d = answers[i];
    const RelativePose& pose = motion.poses[i % kSteps];
    worst = std::max(worst, distance_error(motion, pose, d.distance, d.normal));
    iterations += d.iterations;
  }
  state.counters["support_pairs"] =
      static_cast<double>(iterations) / static_cast<double>(answers.size());
  state.counters["worst_error"] = worst;
  times.report(state);
}

#ifdef PALPATE_BENCH_FCL
void measure_fcl(benchmark::State& state, const Case& what) {
  const std::vector<Motion> motions = make_motions(what.vertices, what.coherence, kPairs, kSteps);
  std::vector<FclMotion> peers;
  peers.reserve(motions.size());
  for (const Motion& motion : motions) peers.emplace_back(motion);
  Times times;
  std::vector<PeerAnswer> answers(kPairs * kSteps);
  for ([[maybe_unused]] const auto pass : state) {
    std::size_t query = 0;
    for (const FclMotion& peer : peers) {
      std::uint64_t last = read_ticks();
      for (std::uint32_t pose = 0; pose < kSteps; ++pose) {
        answers[query] = peer.distance(pose);
        last = times.add(query++, last);
      }
    }
    times.end_pass();
  }
  double worst = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Motion& motion = motions[i / kSteps];
    convex::Cache cold;
    const convex::Distance truth =
        convex::distance(motion.a.baked(), motion.b.baked(), motion.poses[i % kSteps], {}, cold);
    worst = std::max(worst, std::abs(answers[i].distance - truth.distance));
  }
  state.counters["worst_error"] = worst;
  times.report(state);
}
#endif

void add(const std::string& name, void (*measure)(benchmark::State&, const Case&),
         const Case& what) {
  benchmark::RegisterBenchmark(name.c_str(), measure, what)
      ->Iterations(kPasses)
      ->Unit(benchmark::kMillisecond);
}

void add_all() {
  for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
    const std::string motion = coherence == Coherence::coherent ? "/warm/" : "/incoherent/";
    for (const std::uint32_t vertices : kSizes) {
      const std::string end = motion + std::to_string(vertices);
      add("palpate" + end, measure_palpate, {vertices, coherence, &BenchHull::baked});
      add("palpate_scan" + end, measure_palpate, {vertices, coherence, &BenchHull::scanned});
      add("palpate_climb" + end, measure_palpate, {vertices, coherence, &BenchHull::climbed});
#ifdef PALPATE_BENCH_FCL
      add("fcl_libccd" + end, measure_fcl, {vertices, coherence, &BenchHull::baked});
#endif
    }
  }
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  palpate::bench::add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
