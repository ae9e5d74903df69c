// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/deviation.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "decompose_shapes.hpp"
#include "host_bake/metrics/vector.hpp"
#include "host_bake/simplify/simplify.hpp"
#include "mesh_support.hpp"

namespace palpate::bake {
namespace {

constexpr float kRounding = 1e-11f;

NormalMesh flat_mesh(const std::vector<std::array<float, 3>>& points,
                     const std::vector<Face>& faces) {
  return {points, faces, {}, 1};
}

// All faces as one patch: of a patch only its faces count here.
std::vector<Patch> one_patch(const NormalMesh& mesh) {
  std::vector<Patch> patches(1);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) patches[0].faces.push_back(f);
  return patches;
}

float deviation(const NormalMesh& original, const NormalMesh& level) {
  return surface_deviations(NearestSurface(original), level, one_patch(level))[0];
}

std::vector<SimplifiedLevel> levels_of(const NormalMesh& mesh) {
  const CheckReport report = test::sound_report(mesh);
  SimplifyReport unused;
  return simplify(mesh, report, decompose(mesh, report, 1, {}), {}, {}, unused);
}

double waves(const Point& p) { return 0.03 * std::sin(9 * p[0]) * std::sin(11 * p[1] + 5 * p[2]); }

// Points (i, j) of a triangle divided by kSteps: its corners are among them.
template <class Visit>
void for_each_sample(const NormalMesh& mesh, std::uint32_t face, Visit visit) {
  constexpr int kSteps = 24;
  const Face& f = mesh.faces[face];
  const Vec3d a = vec(mesh.points[f[0]]), b = vec(mesh.points[f[1]]), c = vec(mesh.points[f[2]]);
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j)
      visit(a + (double{1} * i / kSteps) * (b - a) + (double{1} * j / kSteps) * (c - a));
  }
}

double largest_edge(const NormalMesh& mesh, std::uint32_t face) {
  const Face& f = mesh.faces[face];
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    largest = std::max(largest, norm(vec(mesh.points[f[i]]) - vec(mesh.points[f[(i + 1) % 3]])));
  }
  return largest;
}

TEST(SurfaceDeviation, Bounds_all_samples_within_the_stated_excess) {
  for (const NormalMesh& mesh :
       {normalise(test::bumpy_sphere(18, waves)), normalise(test::torus(40, 20, 0.4, 0.04, 3))}) {
    const NearestSurface original(mesh);
    for (const SimplifiedLevel& level : levels_of(mesh)) {
      const std::vector<float> s = surface_deviations(original, level.mesh, level.patches);
      ASSERT_EQ(s.size(), level.patches.size());
      for (std::size_t i = 0; i < s.size(); ++i) {
        double sampled = 0, between = 0;
        for (const std::uint32_t f : level.patches[i].faces) {
          between = std::max(between, largest_edge(level.mesh, f) / 24);
          for_each_sample(level.mesh, f, [&](Vec3d p) {
            sampled = std::max(sampled, std::sqrt(original.nearest(p).squared_distance));
          });
        }
        EXPECT_GE(static_cast<double>(s[i]), sampled);
        // No point is farther than `between` from a sample.
        EXPECT_LE(static_cast<double>(s[i]),
                  (1 + kDeviationExcess) * (sampled + between) + kDeviationTolerance);
      }
    }
  }
}

TEST(SurfaceDeviation, Nothing_moved_is_nothing_but_rounding) {
  const NormalMesh mesh = normalise(test::torus(40, 20, 0.4, 0.04, 3));
  std::vector<Patch> patches(mesh.faces.size());
  for (std::uint32_t f = 0; f < patches.size(); ++f) patches[f].faces = {f};
  for (const float s : surface_deviations(NearestSurface(mesh), mesh, patches)) {
    EXPECT_GT(s, 0);
    EXPECT_LT(s, kRounding);
  }
}

TEST(SurfaceDeviation, Flat_surface_divided_otherwise_is_not_off) {
  const NormalMesh fine = normalise(testing::sheet(8));
  const NormalMesh coarse = normalise(testing::sheet(1));
  EXPECT_LT(static_cast<double>(deviation(fine, coarse)), kDeviationTolerance);
  EXPECT_LT(static_cast<double>(deviation(coarse, fine)), kDeviationTolerance);
}

TEST(SurfaceDeviation, One_vertex_bump_has_its_height) {
  for (const float height : {1e-4f, 1e-2f, 0.3f}) {
    const NormalMesh sheet = normalise(testing::sheet(6));
    NormalMesh bumpy = sheet;
    bumpy.points[24][2] += height;  // the middle one of 7 x 7
    const float s = deviation(sheet, bumpy);
    EXPECT_GE(s, height);
    EXPECT_LE(s, 1.1001f * height);
  }
}

TEST(SurfaceDeviation, Lid_over_a_pit_has_the_depth_that_its_points_see) {
  // A square pit with upright walls, half a unit wide and 0.125 deep: the lid's centre is nearest
  // to the bottom.
  const NormalMesh pit = flat_mesh({{-0.25f, -0.25f, 0},
                                    {0.25f, -0.25f, 0},
                                    {0.25f, 0.25f, 0},
                                    {-0.25f, 0.25f, 0},
                                    {-0.25f, -0.25f, -0.125f},
                                    {0.25f, -0.25f, -0.125f},
                                    {0.25f, 0.25f, -0.125f},
                                    {-0.25f, 0.25f, -0.125f}},
                                   {{4, 5, 6},
                                    {4, 6, 7},
                                    {0, 1, 5},
                                    {0, 5, 4},
                                    {1, 2, 6},
                                    {1, 6, 5},
                                    {2, 3, 7},
                                    {2, 7, 6},
                                    {3, 0, 4},
                                    {3, 4, 7}});
  NormalMesh lid = pit;
  lid.faces = {{0, 1, 2}, {0, 2, 3}};
  const float s = deviation(pit, lid);
  EXPECT_GE(s, 0.125f);
  EXPECT_LE(s, 0.1376f);
}

TEST(SurfaceDeviation, Triangles_without_area_and_needles) {
  NormalMesh original = normalise(testing::sheet(3));
  original.faces.push_back({0, 1, 1});  // a segment
  original.faces.push_back({5, 5, 5});  // a point
  NormalMesh level = original;
  level.points.push_back({0, 0, 0.25f});
  const auto tip = static_cast<std::uint32_t>(level.points.size() - 1);
  level.faces = {{5, 6, tip}, {5, tip, tip}, {tip, tip, tip}, {0, 1, 1}};
  const float s = deviation(original, level);
  EXPECT_GE(s, 0.25f);
  EXPECT_LE(s, 0.2751f);
  level.faces = {{0, 1, 1}};
  EXPECT_LT(static_cast<double>(deviation(original, level)), kDeviationTolerance);
}

TEST(SurfaceDeviation, Far_from_a_lone_triangle) {
  const NormalMesh original = flat_mesh({{0, 0, 0}, {1e-3f, 0, 0}, {0, 1e-3f, 0}}, {{0, 1, 2}});
  const NormalMesh level = flat_mesh({{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_GE(deviation(original, level), 1.0f);
  EXPECT_LE(deviation(original, level), 1.1f);
}

TEST(SurfaceDeviation, Same_bits_on_one_thread_and_on_many) {
  const NormalMesh mesh = normalise(test::bumpy_sphere(18, waves));
  const NearestSurface original(mesh);
  const std::vector<SimplifiedLevel> levels = levels_of(mesh);
  const SimplifiedLevel& level = levels[levels.size() / 2];
  const auto on_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return surface_deviations(original, level.mesh, level.patches);
  };
  EXPECT_EQ(on_threads(1), on_threads(4));
}

}  // namespace
}  // namespace palpate::bake
