// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "decompose_oracle.hpp"
#include "decompose_shapes.hpp"
#include "host_bake/decompose/decompose.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

using namespace test;

struct Result {
  NormalMesh mesh;
  CheckReport report;
  std::vector<Patch> patches;
};

Result judged(const NormalMesh& mesh, const CheckReport& report) {
  Result result{mesh, report, decompose(mesh, report, 1, {})};
  EXPECT_EQ(judge_patches(result.mesh, result.report, result.patches), "");
  return result;
}

Result judged(const Mesh& mesh) { return judged(normalise(mesh), check(mesh)); }

std::size_t largest(const std::vector<Patch>& patches) {
  std::size_t faces = 0;
  for (const Patch& patch : patches) faces = std::max(faces, patch.faces.size());
  return faces;
}

TEST(Decompose_convex_bodies, one_patch_all_real) {
  const Mesh bodies[] = {voxels({{0, 0, 0}}), sphere(1), sphere(10, {1, 0.7, 0.5}), cylinder(40),
                         voxels({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})};
  for (const Mesh& body : bodies) {
    const Result result = judged(body);
    ASSERT_EQ(result.patches.size(), 1U) << body.faces.size();
    EXPECT_TRUE(result.patches[0].all_real);
    EXPECT_FALSE(result.patches[0].back_open);
  }
}

TEST(Decompose_fine_cube, sides_are_grown_over_as_a_whole) {
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i < 216; ++i) cells.push_back({i % 6, i / 6 % 6, i / 36});
  const Result result = judged(voxels(cells));
  ASSERT_EQ(result.patches.size(), 1U);
  EXPECT_TRUE(result.patches[0].all_real);
  EXPECT_EQ(result.patches[0].hull.vertices.size(), 8U);
}

TEST(Decompose_large_ellipsoid, one_patch) {
  const Mesh mesh = sphere(50, {1, 0.8, 0.6});
  const auto patches = decompose(normalise(mesh), check(mesh), 1, {});
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_TRUE(patches[0].all_real);
}

TEST(Decompose_l_shaped_prism, few_patches) {
  const Result result = judged(voxels({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_LE(result.patches.size(), 6U);
}

TEST(Decompose_torus, smooth_and_noisy) {
  EXPECT_LT(judged(torus(40, 20, 0.4, 0, 1)).patches.size(), 500U);
  judged(torus(40, 20, 0.4, 0.02, 2));
}

TEST(Decompose_bumpy_sphere, judged_right) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.03, 0.03);
  const Result result = judged(bumpy_sphere(12, [&](const Point&) { return noise(random); }));
  EXPECT_GT(result.patches.size(), 100U);
  judged(bumpy_sphere(14, [](const Point& p) { return 0.2 * std::sin(9 * p[0]) * p[2]; }));
}

TEST(Decompose_plate_with_pit, no_lid) {
  std::vector<std::array<int, 3>> cells;
  for (int x = 0; x < 5; ++x)
    for (int y = 0; y < 5; ++y)
      for (int z = 0; z < 2; ++z)
        if (z == 0 || x < 2 || x > 2 || y < 2 || y > 2) cells.push_back({x, y, z});
  judged(voxels(cells));
}

TEST(Decompose_flat_ring_round_a_dimple, no_lid_at_any_depth) {
  for (const double depth : {0.3, 1e-5, 4e-7}) {
    const Result result = judged(block(12, [&](double x, double y) {
      return -depth * std::max(0.0, 1 - std::hypot(x, y) / 0.4);
    }));
    EXPECT_GT(result.patches.size(), 1U) << depth;
  }
}

TEST(Decompose_cavity, outer_hulls_leave_it_alone) {
  Mesh inner = sphere(4, {0.5, 0.5, 0.5});
  for (Face& f : inner.faces) std::swap(f[1], f[2]);
  const Result result = judged(together(sphere(6), inner));
  EXPECT_GT(result.patches.size(), 8U);
}

TEST(Decompose_body_inside_a_body, hull_does_not_swallow_it) {
  const Mesh small = sphere(2, {0.1, 0.1, 0.1});
  EXPECT_GT(judged(together(sphere(6), small)).patches.size(), 2U);
}

TEST(Decompose_touching_components, both_stay_whole) {
  Mesh second = voxels({{0, 0, 0}});
  for (Point& p : second.points) p[0] += 1;
  const NormalMesh mesh = normalise(together(voxels({{0, 0, 0}}), second));
  EXPECT_EQ(judged(mesh, sound_report(mesh)).patches.size(), 2U);
}

TEST(Decompose_open_hemisphere, small_patches_with_open_backs) {
  const Result result = judged(open_hemisphere(10));
  EXPECT_LE(largest(result.patches), image::kMaxOpenPatchTriangles);
  EXPECT_GT(largest(result.patches), 4U);
  for (const Patch& patch : result.patches) EXPECT_TRUE(patch.back_open);
}

TEST(Decompose_open_plane, plates_stay_small_too) {
  Mesh sheet = block(12, [](double, double) { return 0.0; });
  sheet.faces.resize(4);
  Mesh wide = block(12, [](double, double) { return 0.0; });
  std::erase_if(wide.faces, [&](const Face& f) { return wide.points[f[0]][2] < 0; });
  judged(sheet);
  EXPECT_LE(largest(judged(wide).patches), image::kMaxOpenPatchTriangles);
}

TEST(Decompose_crossing_bodies, crossing_faces_stay_alone) {
  Mesh second = sphere(3);
  for (Point& p : second.points) p[0] += 1.3;
  const Mesh mesh = together(sphere(3), second);
  const CheckReport report = check(mesh);
  ASSERT_FALSE(report.crossing_faces.empty());
  const Result result = judged(normalise(mesh), report);
  for (const Patch& patch : result.patches) EXPECT_TRUE(patch.back_open);
}

TEST(Decompose_faces_without_area, join_what_they_lie_on) {
  // A cube with a vertex in the middle of an edge; between the two sides lies a face without area.
  Mesh mesh = voxels({{0, 0, 0}});
  const Face split = mesh.faces[0];
  const auto middle = static_cast<std::uint32_t>(mesh.points.size());
  Point m;
  for (std::size_t i = 0; i < 3; ++i)
    m[i] = (mesh.points[split[0]][i] + mesh.points[split[1]][i]) / 2;
  mesh.points.push_back(m);
  mesh.faces[0] = {split[0], middle, split[2]};
  mesh.faces.push_back({middle, split[1], split[2]});
  mesh.faces.push_back({split[0], split[1], middle});
  const NormalMesh normal = as_is(mesh);
  const Result result = judged(normal, sound_report(normal));
  ASSERT_EQ(result.patches.size(), 1U);
  EXPECT_TRUE(result.patches[0].all_real);
}

TEST(Decompose_nothing_but_faces_without_area, each_alone) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}};
  mesh.faces = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
  const NormalMesh normal = as_is(mesh);
  const Result result = judged(normal, sound_report(normal));
  EXPECT_EQ(result.patches.size(), 4U);
  EXPECT_EQ(result.patches[0].hull.dimension, 1);
  EXPECT_EQ(result.patches[0].hull.vertices.size(), 2U);
}

TEST(Decompose_folded_sheet, two_sides_do_not_join) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2}, {0, 2, 1}};
  const NormalMesh normal = as_is(mesh);
  EXPECT_EQ(judged(normal, sound_report(normal)).patches.size(), 2U);
}

TEST(Decompose_slivers, judged_right) {
  // A cylinder whose vertices nearly repeat: walls as narrow as the rounding.
  Mesh mesh = cylinder(60);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const double angle = 2e-7 * static_cast<double>(i % 7);
    const Point p = mesh.points[i - i % 2];
    if (i % 2 == 1 && i % 60 != 0)
      mesh.points[i] = {p[0] * std::cos(angle) - p[1] * std::sin(angle),
                        p[0] * std::sin(angle) + p[1] * std::cos(angle), p[2]};
  }
  const NormalMesh normal = normalise(mesh);
  judged(normal, sound_report(normal));
}

TEST(Decompose_tilted_planes, rounding_breaks_planes_up_but_nothing_else) {
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i < 64; ++i) cells.push_back({i % 4, i / 4 % 4, i / 16});
  Mesh mesh = voxels(cells);
  for (Point& p : mesh.points)
    p = {0.36 * p[0] + 0.48 * p[1] - 0.8 * p[2], -0.8 * p[0] + 0.6 * p[1],
         0.48 * p[0] + 0.64 * p[1] + 0.6 * p[2]};
  judged(mesh);
}

TEST(Decompose_random_voxel_bodies, judged_right) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> cell(0, 2);
  for (int round = 0; round < 150; ++round) {
    std::vector<std::array<int, 3>> cells;
    for (int i = 0; i < 2 + round % 14; ++i)
      cells.push_back({cell(random), cell(random), cell(random)});
    const Mesh mesh = voxels(cells);
    SCOPED_TRACE(round);
    judged(mesh);  // also bodies that are not manifold
    if (HasFailure()) break;
  }
}

TEST(Decompose_random_small_bodies, judged_right) {
  std::mt19937 random(12);
  for (int round = 0; round < 150; ++round) {
    // Coarse radii make many exact planes, fine ones none.
    std::uniform_int_distribution<int> level(0, 2 + round % 5);
    const double step = round % 2 == 0 ? 0.25 : 0.01;
    const Mesh mesh =
        bumpy_sphere(1 + round % 3, [&](const Point&) { return step * level(random); });
    SCOPED_TRACE(round);
    judged(mesh);
    if (HasFailure()) break;
  }
}

TEST(Decompose_random_soups, every_face_once_and_no_crash) {
  std::mt19937 random(13);
  for (int round = 0; round < 200; ++round) {
    std::uniform_int_distribution<int> cell(0, 2);
    NormalMesh mesh;
    for (int v = 0; v < 8; ++v)
      mesh.points.push_back({static_cast<float>(cell(random)), static_cast<float>(cell(random)),
                             static_cast<float>(cell(random))});
    std::uniform_int_distribution<std::uint32_t> vertex(0, 7);
    for (int f = 0; f < 12; ++f)
      mesh.faces.push_back({vertex(random), vertex(random), vertex(random)});
    const auto patches = decompose(mesh, sound_report(mesh), 1, {});
    std::vector<int> times(mesh.faces.size(), 0);
    for (const Patch& patch : patches)
      for (const std::uint32_t f : patch.faces) ++times[f];
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), 12);
  }
}

TEST(Decompose_any_number_of_threads, same_patches) {
  const Mesh mesh = torus(30, 16, 0.4, 0.02, 5);
  const NormalMesh normal = normalise(mesh);
  const CheckReport report = check(mesh);
  const auto one = decompose(normal, report, 1, {});
  const auto four = decompose(normal, report, 4, {});
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t p = 0; p < one.size(); ++p) {
    EXPECT_EQ(one[p].faces, four[p].faces);
    EXPECT_EQ(one[p].vertices, four[p].vertices);
    EXPECT_EQ(one[p].hull.faces, four[p].hull.faces);
  }
}

TEST(Decompose_progress, ends_at_one) {
  const Mesh mesh = torus(60, 30, 0.4, 0.02, 6);
  double last = 0;
  decompose(normalise(mesh), check(mesh), 1, [&](std::string_view stage, double done) {
    EXPECT_EQ(stage, "decompose");
    EXPECT_GE(done, last);
    last = done;
  });
  EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace palpate::bake
