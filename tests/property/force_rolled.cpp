// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth contact: an ellipsoid rolls over a golf ball, whose force hardly changes from tick to
// tick. Simplified surfaces have slopes and corners where the original has none, and budgets find
// it late.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/effort.hpp"
#include "tools/bench/bench_query.hpp"
#include "tools/realtime/steady_query.hpp"

namespace palpate::test {
namespace {

using bench::Bench;
using bench::BenchQuery;
using bench::Body;

constexpr double kPeriod_s = 1e-3;
constexpr double kDeltaRel = 0.02;
constexpr std::size_t kTicks = effort<std::size_t>(640, 100);
constexpr bool kWhole = effort(true, false);  // the beginning alone has few corners to compare
constexpr std::size_t kStart = 50;            // ticks that follow the start and are not compared
constexpr std::size_t kFaster = 3;            // 0.37 m/s: every third pose of a way at 0.12 m/s
constexpr std::uint64_t kUnlimited = Budget{}.units;

struct Rolled {
  const Body tool{"ellipsoid", kDeltaRel, bake::ForEngine::both, 2000};
  const Body ball{"golf_ball", kDeltaRel, bake::ForEngine::both, 20'000};
  const double delta_m = kDeltaRel * tool.view.header->radius_m;
  const std::vector<Pose> way = bench::motion({"rolled", "ellipsoid", "golf_ball", false}, tool,
                                              ball, delta_m, kFaster* kTicks);
};

const Rolled& rolled() {
  static const Rolled r;
  return r;
}

std::vector<Pose> poses(bool fast) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < kTicks; ++i) out.push_back(rolled().way[fast ? kFaster * i : i]);
  return out;
}

/// Forces tick by tick.
struct Forces {
  std::vector<Vec3d> found;  ///< the engine's
  std::vector<Vec3d> felt;   ///< steadied
};

Forces forces(const std::vector<Pose>& way, Settings settings, std::uint64_t units = kUnlimited) {
  settings.delta_m = rolled().delta_m;
  Bench bench(rolled().tool, rolled().ball, settings);
  BenchQuery contacts(bench);
  realtime::SteadyQuery query(contacts, {}, settings.stiffness_N_per_m, kPeriod_s);
  Forces out;
  for (const Pose& pose : way) {
    TickResult r;
    EXPECT_EQ(query.tick(pose, {.units = units}, r), Status::ok);
    out.felt.push_back(r.wrench.force_N);
    out.found.push_back(r.wrench.force_N - query.off().force_N);
  }
  return out;
}

double largest_step(const std::vector<Vec3d>& felt) {
  double most = 0;
  for (std::size_t i = kStart; i < felt.size(); ++i) {
    most = std::max(most, norm(felt[i] - felt[i - 1]));
  }
  return most;
}

class RolledEllipsoid : public testing::TestWithParam<bool> {
 protected:
  /// Nor is the force farther off for it, in what can be felt: a hundredth of its peak.
  void expect_steady(const Settings& settings, std::uint64_t units, const std::string& what) const {
    SCOPED_TRACE(what + ", " + std::to_string(units) + " units");
    const Forces f = forces(way_, settings, units);
    const std::vector<Vec3d>& exact = settings.engine == EngineKind::levels ? levels_ : regions_;
    // What a guess has not looked at comes in as steps (docs/CONTACT.md, Sec. 10).
    const double most = settings.engine == EngineKind::levels ? 1.5 : 2.1;
    EXPECT_LE(largest_step(f.felt), most * largest_step(exact));
    if (kWhole) {
      EXPECT_LE(bench::nrmse(f.felt, exact, kStart), bench::nrmse(f.found, exact, kStart) + 0.01);
    }
  }

  const std::vector<Pose> way_ = poses(GetParam());
  const std::vector<Vec3d>& levels_ = exact(GetParam(), EngineKind::levels);
  const std::vector<Vec3d>& regions_ = exact(GetParam(), EngineKind::regions);

 private:
  /// Computed once.
  static const std::vector<Vec3d>& exact(bool fast, EngineKind engine) {
    static std::map<std::pair<bool, EngineKind>, std::vector<Vec3d>> known;
    std::vector<Vec3d>& out = known[{fast, engine}];
    if (out.empty()) out = forces(poses(fast), {.engine = engine, .exact = true}).found;
    return out;
  }
};

TEST_P(RolledEllipsoid, steadied_force_steps_at_most_half_as_far_again_as_the_exact_one) {
  for (const std::uint64_t units : {kUnlimited, std::uint64_t{60}}) {
    constexpr double kThresholds[] = {0.005, 0.015, 0.05};
    for (const double s0 : std::span(kThresholds).first(effort(3u, 1u))) {
      expect_steady({.s0 = s0}, units, "s0 = " + std::to_string(s0));
    }
    expect_steady({.s0 = 1e3, .kappa = 0.1}, units, "kappa = 0.1");
    expect_steady({.exact = true}, units, "exact");
  }
}

TEST_P(RolledEllipsoid, of_regions_steps_so_too) {
  for (const std::uint64_t units : {2500u, 1000u, 500u, 200u}) {
    expect_steady({.engine = EngineKind::regions}, units, "regions");
  }
}

TEST_P(RolledEllipsoid, of_an_exact_query_is_left_alone) {
  for (const EngineKind engine : {EngineKind::levels, EngineKind::regions}) {
    const Forces exact = forces(way_, {.engine = engine, .exact = true});
    EXPECT_LE(bench::nrmse(exact.felt, exact.found, kStart), 1e-12);
  }
}

TEST_P(RolledEllipsoid, without_steadying_it_is_worse) {
  if (!kWhole) GTEST_SKIP() << "the beginning of the way has no such corner";
  EXPECT_GT(largest_step(forces(way_, {.s0 = 0.05}).found), 2 * largest_step(levels_));
}

TEST_P(RolledEllipsoid, under_kappa_steps_so_without_steadying) {
  EXPECT_LE(largest_step(forces(way_, {.s0 = 1e3, .kappa = 0.1}).found),
            1.5 * largest_step(levels_));
}

INSTANTIATE_TEST_SUITE_P(Speeds, RolledEllipsoid, testing::Values(false, true),
                         [](const auto& tested) {
                           return std::string(tested.param ? "370" : "120") + "_mm_per_s";
                         });

}  // namespace
}  // namespace palpate::test
