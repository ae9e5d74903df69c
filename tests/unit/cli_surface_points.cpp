// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/surface_points.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "host_bake/metrics/nearest_on_triangle.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::cli {
namespace {

double off_surface(const bake::Mesh& mesh, const Pose& pose, Vec3d p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.faces) {
    const Vec3d q = bake::nearest_on_triangle(p, test::place(pose, mesh.points[t[0]]),
                                              test::place(pose, mesh.points[t[1]]),
                                              test::place(pose, mesh.points[t[2]]));
    least = std::min(least, norm(p - q));
  }
  return least;
}

class SurfacePointsOf : public testing::TestWithParam<EngineKind> {};

TEST_P(SurfacePointsOf, overlaps_lie_on_both_surfaces_and_others_stay) {
  const bool levels = GetParam() == EngineKind::levels;
  const auto engine = levels ? bake::ForEngine::levels : bake::ForEngine::regions;
  const test::BakedBody a(test::bumpy_ball(14, 20, 1), engine);
  const test::BakedBody b(test::bumpy_ball(16, 16, 0.8), engine);
  test::BakedScene scene({a.view, b.view}, {{0, 1}},
                         {.engine = GetParam(), .delta_m = 0.05, .exact = true});
  SurfacePoints surface_points(scene.bodies, scene.pairs);
  double furthest = 0;
  for (int i = 0; i < 10; ++i) {
    const Pose poses[2] = {{{1.66, 0.02 * i, 0.1}, test::turn({0.3, 0.1 * i, 0.2})},
                           {{0.1, 0.2, -0.1}, test::turn({0, 0.4, 0.1})}};
    const TickResult r = test::tick_or_fail(*scene.engine, poses);
    const std::span<const Contact> found = surface_points.of(r.contacts, poses);
    ASSERT_EQ(found.size(), r.contacts.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Contact &c = found[k], &was = r.contacts[k];
      EXPECT_LT(off_surface(a.mesh, poses[0], c.point_a_m), 1e-6);
      EXPECT_LT(off_surface(b.mesh, poses[1], c.point_b_m), 1e-6);
      EXPECT_EQ(c.distance_m, was.distance_m);
      furthest = std::max(furthest, off_surface(a.mesh, poses[0], was.point_a_m));
      if (was.distance_m > 0) {
        EXPECT_EQ(c.point_a_m, was.point_a_m);
        EXPECT_EQ(c.point_b_m, was.point_b_m);
      }
    }
  }
  if (levels) {  // whose points are those of hulls
    EXPECT_GT(furthest, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, SurfacePointsOf,
                         testing::Values(EngineKind::levels, EngineKind::regions));

}  // namespace
}  // namespace palpate::cli
