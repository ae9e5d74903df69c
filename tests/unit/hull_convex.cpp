// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "host_bake/hull/facets.hpp"
#include "host_bake/hull/hull.hpp"
#include "host_bake/hull/quickhull.hpp"
#include "hull_oracle.hpp"

namespace palpate::bake {
namespace {

using test::judge_hull;

std::vector<PointF> grid_points(std::mt19937& random, std::size_t count, int size) {
  std::uniform_int_distribution<int> cell(0, size);
  std::vector<PointF> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({static_cast<float>(cell(random)), static_cast<float>(cell(random)),
                      static_cast<float>(cell(random))});
  return points;
}

std::vector<PointF> ball_points(std::mt19937& random, std::size_t count) {
  std::normal_distribution<float> normal;
  std::vector<PointF> points;
  for (std::size_t i = 0; i < count; ++i) {
    const PointF p = {normal(random), normal(random), normal(random)};
    const float l = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    points.push_back({p[0] / l, p[1] / l, p[2] / l});
  }
  return points;
}

bool same(const HullMesh& a, const HullMesh& b) {
  return a.dimension == b.dimension && a.vertices == b.vertices && a.faces == b.faces;
}

TEST(ConvexHull_single_point, repeated_points_make_a_point) {
  const std::vector<PointF> points(3, {1, 2, 3});
  const HullMesh hull = convex_hull(points);
  EXPECT_EQ(hull.dimension, 0);
  EXPECT_EQ(hull.vertices, (std::vector<std::uint32_t>{0}));
  EXPECT_TRUE(hull.faces.empty());
}

TEST(ConvexHull_straight_points, ends_make_a_segment) {
  const std::vector<PointF> points = {{1, 1, 1}, {3, 3, 3}, {0, 0, 0}, {2, 2, 2}, {3, 3, 3}};
  const HullMesh hull = convex_hull(points);
  EXPECT_EQ(hull.dimension, 1);
  EXPECT_EQ(hull.vertices, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_TRUE(hull.faces.empty());
}

TEST(ConvexHull_flat_grid, corners_make_both_sides) {
  std::vector<PointF> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      points.push_back({static_cast<float>(i), static_cast<float>(j), static_cast<float>(i + j)});
  const HullMesh hull = convex_hull(points);
  EXPECT_EQ(hull.dimension, 2);
  EXPECT_EQ(hull.vertices, (std::vector<std::uint32_t>{0, 3, 12, 15}));
  EXPECT_EQ(hull.faces.size(), 4U);
  EXPECT_EQ(judge_hull(points, hull), "");
}

TEST(ConvexHull_solid_grid, only_corners_stay) {
  std::vector<PointF> points;
  for (int i = 0; i < 125; ++i)
    points.push_back(
        {static_cast<float>(i % 5), static_cast<float>(i / 5 % 5), static_cast<float>(i / 25)});
  const HullMesh hull = convex_hull(points);
  EXPECT_EQ(hull.vertices.size(), 8U);
  EXPECT_EQ(hull.faces.size(), 12U);
  EXPECT_EQ(judge_hull(points, hull), "");
}

TEST(ConvexHull_nearly_flat, last_bit_decides) {
  std::vector<PointF> points = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  EXPECT_EQ(convex_hull(points).dimension, 2);
  points[3][2] = std::nextafter(1.0F, 2.0F);
  EXPECT_EQ(convex_hull(points).dimension, 3);
  EXPECT_EQ(judge_hull(points, convex_hull(points)), "");
}

TEST(ConvexHull_tiny_beside_large, exact_over_the_range_of_float) {
  const std::vector<PointF> points = {{1, 0, 0},      {0, 1, 0},       {-1, -1, 0},
                                      {0, 0, 1e-40F}, {0, 0, -1e-40F}, {1e-30F, 0, 0}};
  const HullMesh hull = convex_hull(points);
  EXPECT_EQ(hull.vertices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(judge_hull(points, hull), "");
}

TEST(ConvexHull_small_degenerate_sets, judged_right) {
  std::mt19937 random(1);
  for (int round = 0; round < 3000; ++round) {
    const auto points =
        grid_points(random, 1 + static_cast<std::size_t>(round % 12), 1 + round % 4);
    ASSERT_EQ(judge_hull(points, convex_hull(points)), "") << "round " << round;
  }
}

TEST(ConvexHull_random_sets, judged_right) {
  std::mt19937 random(2);
  for (const std::size_t count : {5U, 20U, 32U, 33U, 60U, 150U}) {
    const auto on_sphere = ball_points(random, count);
    EXPECT_EQ(judge_hull(on_sphere, convex_hull(on_sphere)), "");
    const auto on_grid = grid_points(random, count, 5);
    EXPECT_EQ(judge_hull(on_grid, convex_hull(on_grid)), "");
  }
}

TEST(ConvexHull_small_sets, agree_with_quickhull) {
  std::mt19937 random(3);
  for (int round = 0; round < 2000; ++round) {
    const std::size_t count = 5 + static_cast<std::size_t>(round % 24);
    const auto points =
        round % 2 == 0 ? ball_points(random, count) : grid_points(random, count, 2 + round % 5);
    const HullMesh hull = convex_hull(points);
    if (hull.dimension < 3) continue;
    std::vector<std::uint32_t> ids(points.size());
    std::iota(ids.begin(), ids.end(), 0U);
    std::sort(ids.begin(), ids.end(), [&](std::uint32_t a, std::uint32_t b) {
      return points[a] != points[b] ? points[a] < points[b] : a < b;
    });
    ids.erase(std::unique(ids.begin(), ids.end(),
                          [&](std::uint32_t a, std::uint32_t b) { return points[a] == points[b]; }),
              ids.end());
    if (ids.size() == 4) continue;  // see quickhull.hpp
    ASSERT_TRUE(same(hull, canonical_hull(points, quickhull(points, ids)).mesh)) << round;
  }
}

TEST(ConvexHull_any_order, same_hull_but_for_names) {
  std::mt19937 random(4);
  for (int round = 0; round < 100; ++round) {
    const auto points = grid_points(random, 10 + static_cast<std::size_t>(round), 3);
    std::vector<PointF> shuffled = points;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    const auto corners = [](const std::vector<PointF>& from) {
      std::vector<PointF> found;
      for (const std::uint32_t v : convex_hull(from).vertices) found.push_back(from[v]);
      std::sort(found.begin(), found.end());
      return found;
    };
    ASSERT_EQ(corners(points), corners(shuffled));
  }
}

TEST(ConvexHull_many_points, closed_and_extreme) {
  std::mt19937 random(5);
  const auto points = ball_points(random, 20000);
  const HullMesh hull = convex_hull(points);
  EXPECT_EQ(hull.faces.size(), 2 * hull.vertices.size() - 4);
  EXPECT_GT(hull.vertices.size(), 19000U);
}

}  // namespace
}  // namespace palpate::bake
