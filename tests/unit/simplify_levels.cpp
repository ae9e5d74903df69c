// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "decompose_shapes.hpp"
#include "host_bake/models/models.hpp"
#include "simplify_judge.hpp"
#include "tests/support/effort.hpp"

namespace palpate::bake {
namespace {

using namespace test;

constexpr SimplifyOptions kToTheEnd{0.0, 0};
constexpr std::size_t kTriangles = palpate::test::effort<std::size_t>(3000, 2000);

TEST(Simplify_models, hold_all_invariants_at_every_level) {
  for (const ModelInfo& model : models()) {
    const std::size_t triangles = std::max(model.least_triangles, kTriangles);
    const Simplified result = simplified(make_model(model.name, triangles));
    EXPECT_EQ(judge_levels(result), "") << model.name;
    ASSERT_FALSE(result.levels.empty()) << model.name;
    EXPECT_LT(2 * result.levels.back().mesh.faces.size(), result.mesh.faces.size()) << model.name;
  }
}

TEST(Simplify_rough_and_smooth_bodies, hold_all_invariants_to_the_end) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  const Mesh bodies[] = {
      bumpy_sphere(10, [&](const Point&) { return noise(random); }),
      torus(30, 16, 0.4, 0, 1),
      torus(30, 16, 0.4, 0.03, 2),
      sphere(12, {1, 0.7, 0.4}),
      cylinder(60),
      block(14, [](double x, double y) { return 0.2 * std::sin(5 * x) * std::cos(4 * y); }),
      voxels({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
  };
  for (const Mesh& body : bodies)
    EXPECT_EQ(judge_levels(simplified(body, kToTheEnd)), "") << body.faces.size();
}

TEST(Simplify_open_surfaces, keep_their_boundary_and_small_patches) {
  const Simplified result = simplified(open_hemisphere(12), kToTheEnd);
  EXPECT_EQ(judge_levels(result), "");
  EXPECT_FALSE(result.levels.empty());
}

TEST(Simplify_components, stay_apart_from_each_other) {
  Mesh near = sphere(8);
  for (Point& p : near.points) p[0] += 2.001;
  Mesh tiny = sphere(2);
  for (Point& p : tiny.points)
    for (std::size_t i = 0; i < 3; ++i) p[i] = 0.004 * p[i] + (i == 2 ? 1.01 : 0.0);
  const Simplified result = simplified(together(together(sphere(8), near), tiny), kToTheEnd);
  EXPECT_EQ(judge_levels(result), "");
  EXPECT_FALSE(result.levels.empty());
}

TEST(Simplify_convex_body, stays_one_piece) {
  const Simplified result = simplified(sphere(20));
  ASSERT_EQ(result.levels.size(), 1U);
  EXPECT_EQ(result.levels[0].patches.size(), 1U);
  EXPECT_TRUE(result.levels[0].patches[0].all_real);
  EXPECT_EQ(judge_levels(result), "");
}

TEST(Simplify_fine_cube, keeps_its_planes) {
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i < 216; ++i) cells.push_back({i % 6, i / 6 % 6, i / 36});
  const Simplified result = simplified(voxels(cells), {0.9, 0});
  ASSERT_FALSE(result.levels.empty());
  EXPECT_EQ(judge_levels(result), "");
  EXPECT_LE(result.levels.back().mesh.faces.size(), 60U);
}

TEST(Simplify_stop_rules, end_the_process) {
  const Mesh mesh = make_model("golf_ball", 4000);
  const Simplified fine = simplified(mesh, {12, 0});
  EXPECT_GE(fine.report.last_resolution, 12);
  const Simplified pieces = simplified(mesh, {0, 100});
  EXPECT_LE(pieces.levels.back().patches.size(), 100U);
  EXPECT_GT(pieces.levels.back().patches.size(), 90U);
}

TEST(Simplify_crossing_faces, stay_as_they_are) {
  Mesh other = sphere(6);
  for (Point& p : other.points) p[0] += 1.5;
  const Mesh mesh = together(sphere(6), other);
  const Simplified result = simplified(mesh, kToTheEnd);
  ASSERT_FALSE(result.check.crossing_faces.empty());
  EXPECT_EQ(judge_levels(result), "");
  ASSERT_FALSE(result.levels.empty());
  const SimplifiedLevel& level = result.levels.front();
  for (const std::size_t f : result.check.crossing_faces)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(level.mesh.points[level.mesh.faces[level.face_of_face[f]][i]],
                result.mesh.points[result.mesh.faces[f][i]]);
}

TEST(Simplify, is_deterministic) {
  const Mesh mesh = make_model("jaw_lower", kTriangles);
  const Simplified a = simplified(mesh);
  const Simplified b = simplified(mesh);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].mesh.points, b.levels[i].mesh.points);
    EXPECT_EQ(a.levels[i].mesh.faces, b.levels[i].mesh.faces);
    EXPECT_EQ(a.levels[i].parent_of_patch, b.levels[i].parent_of_patch);
  }
}

}  // namespace
}  // namespace palpate::bake
