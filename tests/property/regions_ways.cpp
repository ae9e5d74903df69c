// SPDX-License-Identifier: GPL-3.0-or-later
// Random ways of one body past another: what the region engine remembers from tick to tick, leaves
// to a tolerance or has no budget for, against exact answers that know nothing of the tick before.
#include <gtest/gtest.h>

#include <string>

#include "host_bake/models/models.hpp"
#include "tests/support/answers.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

// PALPATE_WAYS and PALPATE_TRIANGLES are set by the build, for a short test and a long one.
constexpr int kWays = PALPATE_WAYS;
constexpr std::size_t kTriangles = PALPATE_TRIANGLES;
constexpr int kTicks = effort(40, 15);  // of one way
constexpr double kRough = 0.002;
constexpr double kRounding = 2e-6;  // of the larger radius, 1
constexpr double kTolerance_N = 1;
constexpr double kStiffness = 600;

/// About the origin, and as rough as a scan: so there are many places as near.
bake::Mesh model(const char* name, double radius) {
  bake::Mesh mesh = bake::make_model(name, kTriangles);
  const bake::NormalMesh normal = bake::normalise(mesh);
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> rough(-kRough, kRough);
  for (bake::Point& p : mesh.points) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = (p[k] - normal.centre_m[k]) / normal.radius_m + rough(rng);
    }
  }
  return scaled(mesh, radius);
}

struct Case {
  const char* a;  // of radius 1
  const char* b;
  double radius_b;
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.a << "_" << c.b; }

class RegionsWays : public testing::TestWithParam<Case> {};

/// What is asked at every pose.
struct Asked {
  const char* how;
  Budget budget;
  bool exact;
  double tolerance_N = 0;
};

constexpr Asked kAsked[] = {
    {"from tick to tick", {}, true},
    {"the force", {}, false},
    {"with a tolerance", {}, false, kTolerance_N},
    {"50 units", {.units = 50}, true},
    {"150 units", {.units = 150}, false},
    {"500 units", {.units = 500}, true},
    {"2000 units", {.units = 2000}, false},
    {"150 units and a tolerance", {.units = 150}, false, kTolerance_N},
};

void expect_sound(const TickResult& r, double truth) {
  for (const Contact& c : r.contacts) {
    EXPECT_GE(norm(c.point_a_m - c.point_b_m), truth - kRounding);
    EXPECT_NEAR(norm(c.normal), 1, 1e-6);
    EXPECT_GE(c.share, 0);
    EXPECT_LE(c.share, 1);
  }
  EXPECT_GE(r.certificate.force_bound_N, 0);
}

double distance_within(const TickResult& r, double delta) {
  return r.contacts.empty() ? delta : r.min_distance_m;
}

/// Passes at a random distance below delta, on a straight line and turning.
struct Way {
  Pose pose;
  Vec3d step;
  Quat turned;

  Way(Engine& engine, double delta, std::mt19937& rng) {
    std::uniform_real_distribution<double> from_0_to_1;
    const Vec3d direction = random_unit(rng);
    const double gap = delta * (0.05 + 0.9 * from_0_to_1(rng));
    pose = {3.0 * direction, turn(3.0 * random_unit(rng))};
    for (int i = 0; i < 2000; ++i) {
      const Pose poses[2] = {pose, {}};
      const double d = distance_within(tick_or_fail(engine, poses), delta);
      if (d < 1.05 * gap) break;
      pose.position_m -= (d - gap) * direction;
    }
    const double length = delta * std::pow(10, -2 + 2 * from_0_to_1(rng));
    const Vec3d any = random_unit(rng);
    step = length * (any - dot(any, direction) * direction);
    turned = turn(length * from_0_to_1(rng) * random_unit(rng));
  }
  void go_on() {
    pose.position_m += step;
    pose.orientation = turned * pose.orientation;
  }
};

TEST_P(RegionsWays, what_is_certified_holds) {
  const BakedBody a(model(GetParam().a, 1), bake::ForEngine::regions);
  const BakedBody b(model(GetParam().b, GetParam().radius_b), bake::ForEngine::regions);
  std::mt19937 rng(5);
  int apart = 0;
  for (const double delta : {0.005, 0.02, 0.05}) {
    const auto scene_with = [&](bool exactly, double tolerance_N = 0) {
      return BakedScene({a.view, b.view}, {{0, 1}},
                        {.engine = EngineKind::regions,
                         .delta_m = delta,
                         .exact = exactly,
                         .force_tolerance_N = tolerance_N,
                         .stiffness_N_per_m = kStiffness,
                         .cluster_radius_m = delta});
    };
    std::vector<BakedScene> scenes;
    for (const Asked& asked : kAsked) {
      scenes.push_back(scene_with(asked.exact, asked.tolerance_N));
    }
    for (int i = 0; i < kWays; ++i) {
      Way way(*scene_with(true).engine, delta, rng);
      for (int t = 0; t < kTicks; ++t, way.go_on()) {
        const Pose poses[2] = {way.pose, {}};
        const BakedScene anew = scene_with(true);
        const TickResult exact = tick_or_fail(*anew.engine, poses);
        const double truth = distance_within(exact, delta);
        apart += truth > 0 ? 1 : 0;
        expect_sound(exact, truth);
        for (std::size_t k = 0; k < scenes.size(); ++k) {
          SCOPED_TRACE(std::string(kAsked[k].how) + ", delta " + std::to_string(delta) + ", way " +
                       std::to_string(i) + ", tick " + std::to_string(t));
          const TickResult r = tick_or_fail(*scenes[k].engine, poses, kAsked[k].budget);
          expect_sound(r, truth);
          expect_certified(r, std::max(0.0, truth), delta);
          EXPECT_LE(norm(r.wrench.force_N - exact.wrench.force_N),
                    r.certificate.force_bound_N + 2 * kStiffness * kRounding);
          if (kAsked[k].tolerance_N > 0 && !r.certificate.truncated()) {
            EXPECT_LE(r.certificate.force_bound_N, kTolerance_N * 1.00001);
          }
          if (HasFailure()) return;
        }
      }
    }
  }
  EXPECT_GT(apart, 3 * kWays);
}

INSTANTIATE_TEST_SUITE_P(Models, RegionsWays,
                         testing::Values(Case{"golf_ball", "golf_shell", 1},
                                         Case{"screw", "nut", 1}, Case{"jaw_lower", "jaw_upper", 1},
                                         Case{"golf_club", "ball_joint_cup", 0.2}),
                         [](const auto& tested) {
                           return std::string(tested.param.a) + "_" + tested.param.b;
                         });

}  // namespace
}  // namespace palpate::test
