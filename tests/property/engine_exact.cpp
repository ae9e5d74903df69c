// SPDX-License-Identifier: GPL-3.0-or-later
// The exact contact query against brute force over all triangles.
#include <gtest/gtest.h>

#include "tests/support/brute_force.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

void expect_exact(const TickResult& result, const bake::Mesh& mesh_a, const PlacedTriangles& a,
                  const PlacedTriangles& b, double delta, double unit) {
  const double truth = distance_of(a, b);
  if (truth < 0.99 * delta) {
    ASSERT_FALSE(result.contacts.empty()) << "true distance " << truth << " of delta " << delta;
    EXPECT_NEAR(result.min_distance_m, truth, 2e-6 * unit);
  }
  EXPECT_LT(result.certificate.error_bound_m, 1e-5 * unit);
  for (const Contact& c : result.contacts) {
    EXPECT_NEAR(norm(c.point_a_m - c.point_b_m), std::abs(c.distance_m), 1e-6 * unit);
    EXPECT_NEAR(norm(c.normal), 1, 1e-9);
    if (c.distance_m > 1e-4 * unit) {
      EXPECT_NEAR(dot(c.normal, c.point_a_m - c.point_b_m), c.distance_m, 1e-6 * unit);
    }
  }
  for (const auto& region : near_regions(mesh_a, a, b, 0.98 * delta)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Contact& c : result.contacts)
      nearest = std::min(nearest, distance_to(a, region, c.point_a_m));
    EXPECT_LE(nearest, delta) << "a region of " << region.size() << " triangles has no contact";
  }
}

struct Case {
  const char* name;
  bake::Mesh (*a)();
  bake::Mesh (*b)();
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.name; }

class EngineExact : public testing::TestWithParam<Case> {};

TEST_P(EngineExact, coherent_and_incoherent_poses_agree_with_brute_force) {
  for (const double scale : {1e-6, 1.0, 1e4}) {
    const BakedBody a(scaled(GetParam().a(), scale));
    const BakedBody b(scaled(GetParam().b(), scale));
    const double unit = std::max(a.view.header->radius_m, b.view.header->radius_m);
    const double delta = 0.05 * std::min(a.view.header->radius_m, b.view.header->radius_m);
    BakedScene scene({a.view, b.view}, {{0, 1}},
                     {.delta_m = delta, .exact = true, .cluster_radius_m = delta});
    const PlacedTriangles fixed(b.mesh, {});
    for_each_placement(a, b, delta, 5, [&](std::span<const Pose> poses) {
      const TickResult result = tick_or_fail(*scene.engine, poses);
      expect_exact(result, a.mesh, PlacedTriangles(a.mesh, poses[0]), fixed, delta, unit);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EngineExact,
                         testing::Values(Case{"bumpy_balls", [] { return bumpy_ball(10, 14, 1); },
                                              [] { return bumpy_ball(12, 12, 0.8); }},
                                         Case{"ball_on_ring", [] { return ball(8, 12, 0.5); },
                                              [] { return ring(20, 10, 1, 0.3); }},
                                         Case{"boxes", [] { return box(0.5, 0.3, 0.2); },
                                              [] { return box(1, 1, 0.1); }},
                                         Case{"open_bowl", [] { return ball(6, 8, 0.3); },
                                              [] { return bowl(6, 12, 1); }},
                                         Case{"two_components",
                                              [] {
                                                Mesh m = bumpy_ball(8, 10, 0.5);
                                                append(m, ball(6, 8, 0.2), 0.8, 0, 0);
                                                return m;
                                              },
                                              [] { return ring(16, 8, 1, 0.3); }}),
                         [](const auto& tested) { return tested.param.name; });

TEST(EngineExact, ball_inside_an_open_bowl_touches_its_inner_side) {
  const BakedBody a(ball(8, 12, 0.5));
  const BakedBody b(bowl(8, 16, 1));
  const double delta = 0.05;
  BakedScene scene({a.view, b.view}, {{0, 1}}, {.delta_m = delta, .exact = true});
  const PlacedTriangles fixed(b.mesh, {});
  for (int i = 0; i < 20; ++i) {
    const Pose poses[2] = {{{0.02 * i - 0.2, 0.1, -0.43 + 0.002 * i}, {}}, {}};
    const PlacedTriangles moved(a.mesh, poses[0]);
    const double truth = distance_of(moved, fixed);
    ASSERT_GT(truth, 0);
    const TickResult result = tick_or_fail(*scene.engine, poses);
    expect_exact(result, a.mesh, moved, fixed, delta, 1);
  }
}

// The tree above the original pieces is another one there.
TEST(EngineExact, contacts_are_the_same_on_images_for_the_regions_engine) {
  constexpr bake::ForEngine kRegions = bake::ForEngine::regions;
  const BakedBody a(bumpy_ball(12, 16, 1)), lean_a(bumpy_ball(12, 16, 1), kRegions);
  const BakedBody b(bumpy_ball(14, 14, 0.8)), lean_b(bumpy_ball(14, 14, 0.8), kRegions);
  EXPECT_LT(lean_a.view.header->free_levels, a.view.header->free_levels / 2);
  // Without stiffness: of the pieces alone.
  const Settings settings{.delta_m = 0.05, .exact = true, .stiffness_N_per_m = 0};
  BakedScene all({a.view, b.view}, {{0, 1}}, settings);
  BakedScene lean({lean_a.view, lean_b.view}, {{0, 1}}, settings);
  int touching = 0;
  for (int i = 0; i < 50; ++i) {
    const Pose poses[2] = {slid(i), {}};
    const TickResult r = tick_or_fail(*all.engine, poses);
    const TickResult s = tick_or_fail(*lean.engine, poses);
    ASSERT_EQ(r.contacts.size(), s.contacts.size()) << i;
    if (r.contacts.empty()) continue;
    ++touching;
    EXPECT_NEAR(r.min_distance_m, s.min_distance_m, 1e-9) << i;
  }
  EXPECT_GT(touching, 10);
}

TEST(EngineExact, moving_both_bodies_turns_the_wrench_with_them) {
  const BakedBody a(bumpy_ball(12, 16, 1));
  const BakedBody b(bumpy_ball(14, 14, 0.8));
  BakedScene one({a.view, b.view}, {{0, 1}},
                 {.delta_m = 0.05, .exact = true, .cluster_radius_m = 0.1});
  BakedScene other({a.view, b.view}, {{0, 1}},
                   {.delta_m = 0.05, .exact = true, .cluster_radius_m = 0.1});
  expect_wrench_turns_with_the_world(one, other, 50, slid);
}

TEST(EngineExact, swapping_the_bodies_of_a_pair_mirrors_the_force) {
  const BakedBody a(bumpy_ball(12, 16, 1));
  const BakedBody b(ring(16, 8, 1, 0.3));
  const Settings settings{.delta_m = 0.05, .exact = true, .cluster_radius_m = 0.1};
  BakedScene forward({a.view, b.view}, {{0, 1}}, settings);
  BakedScene backward({a.view, b.view}, {{1, 0}}, settings);
  const Pose poses[2] = {approach(a.mesh, b.mesh, 0.02, 4, {0, 0, 1}, turn({0.2, 0.1, 0})), {}};
  const TickResult f = tick_or_fail(*forward.engine, poses);
  const TickResult g = tick_or_fail(*backward.engine, poses);
  ASSERT_FALSE(f.contacts.empty());
  EXPECT_NEAR(f.min_distance_m, g.min_distance_m, 1e-6);
  EXPECT_NEAR(norm(f.wrench.force_N - g.wrench.force_N), 0, 1e-3 * norm(f.wrench.force_N));
}

}  // namespace
}  // namespace palpate::test
