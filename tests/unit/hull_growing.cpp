// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "host_bake/hull/growing_hull.hpp"
#include "host_bake/hull/predicates.hpp"
#include "hull_oracle.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint32_t kAnywhere = GrowingHull::kNone;

// The unit cube; vertex 4 z + 2 y + x.
const std::vector<PointF> kCube = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
const std::vector<std::uint32_t> kBottom = {0, 2, 3, 1};  // seen from below

/// Living facets as a set, each starting with its lowest vertex.
std::vector<Triangle> facets(const GrowingHull& hull) {
  std::vector<Triangle> all = hull.triangles();
  for (Triangle& t : all) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(all.begin(), all.end());
  return all;
}

void expect_consistent(const GrowingHull& hull) {
  const auto slots = hull.slots();
  for (std::uint32_t f = 0; f < slots.size(); ++f) {
    if (!slots[f].alive) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const GrowingHull::Facet& g = slots[slots[f].neighbours[i]];
      ASSERT_TRUE(g.alive);
      const std::uint32_t from = slots[f].vertices[i];
      const std::uint32_t to = slots[f].vertices[(i + 1) % 3];
      bool mutual = false;
      for (std::size_t k = 0; k < 3; ++k)
        mutual = mutual ||
                 (g.vertices[k] == to && g.vertices[(k + 1) % 3] == from && g.neighbours[k] == f);
      ASSERT_TRUE(mutual);
      ASSERT_TRUE(hull.has(from));
    }
  }
}

TEST(Predicates_random_and_degenerate, agree_with_whole_numbers) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> cell(0, 3);
  std::uniform_real_distribution<float> real(-1, 1);
  const auto point = [&](bool grid) {
    return grid ? PointF{0.1F * static_cast<float>(cell(random)),
                         0.1F * static_cast<float>(cell(random)),
                         0.1F * static_cast<float>(cell(random))}
                : PointF{real(random), real(random), real(random)};
  };
  for (int round = 0; round < 5000; ++round) {
    const bool grid = round % 4 != 0;
    const PointF a = point(grid);
    const PointF b = point(grid);
    const PointF c = point(grid);
    const PointF d = point(grid);
    ASSERT_EQ(orient_3d(a, b, c, d), test::exact_side(a, b, c, d));
    ASSERT_EQ(collinear(a, b, c), test::in_line(a, b, c));
    ASSERT_EQ(projection_of(a, b, c).facing == 0, test::in_line(a, b, c));
  }
}

TEST(GrowingHull_start, two_sides) {
  GrowingHull hull(kCube);
  hull.start(kBottom, true);
  EXPECT_TRUE(hull.flat());
  EXPECT_EQ(hull.triangles().size(), 4U);
  expect_consistent(hull);
}

TEST(GrowingHull_vertex_above_real_plane, refused_and_unchanged) {
  std::vector<PointF> points = kCube;
  points.push_back({0.5F, 0.5F, -1});
  GrowingHull hull(points);
  hull.start(kBottom, true);
  const auto before = facets(hull);
  EXPECT_FALSE(hull.insert(8, kAnywhere));
  EXPECT_EQ(facets(hull), before);
  EXPECT_TRUE(hull.insert(4, 0));
  EXPECT_FALSE(hull.flat());
  EXPECT_FALSE(hull.insert(8, 4));
  expect_consistent(hull);
}

TEST(GrowingHull_inside_and_on_it, nothing_changes) {
  std::vector<PointF> points = kCube;
  points.push_back({0.5F, 0.5F, 0.5F});
  points.push_back({0.5F, 0.5F, 1});
  points.push_back({1, 0, 1});
  GrowingHull hull(points);
  hull.start(kBottom, false);
  for (std::uint32_t v = 4; v < 8; ++v) ASSERT_TRUE(hull.insert(v, kAnywhere));
  const auto before = facets(hull);
  for (std::uint32_t v = 8; v < 11; ++v) {
    EXPECT_TRUE(hull.insert(v, 7));
    EXPECT_FALSE(hull.has(v));
  }
  EXPECT_EQ(facets(hull), before);
}

TEST(GrowingHull_supported_by, star_and_scan_agree) {
  GrowingHull hull(kCube);
  hull.start(kBottom, true);
  for (std::uint32_t v = 4; v < 8; ++v) ASSERT_TRUE(hull.insert(v, kAnywhere));
  for (const std::uint32_t near : {4U, kAnywhere}) {
    EXPECT_TRUE(hull.supported_by({4, 5, 7}, near));
    EXPECT_FALSE(hull.supported_by({4, 7, 5}, near));
    EXPECT_FALSE(hull.supported_by({4, 1, 2}, near));
  }
}

TEST(GrowingHull_mark_real, whole_facet_protected) {
  std::vector<PointF> points = kCube;
  points.push_back({0.9F, 0.9F, 1.5F});
  GrowingHull hull(points);
  hull.start(kBottom, true);
  for (std::uint32_t v = 4; v < 8; ++v) ASSERT_TRUE(hull.insert(v, kAnywhere));
  const GrowingHull::Mark mark = hull.mark();
  hull.mark_real({4, 5, 7}, 4);
  EXPECT_FALSE(hull.insert(8, kAnywhere));
  hull.rollback(mark);
  EXPECT_TRUE(hull.insert(8, kAnywhere));
  EXPECT_TRUE(hull.has(8));
}

TEST(GrowingHull_extended_in_a_real_plane, new_triangles_are_real) {
  const std::vector<PointF> points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0},
                                      {0, 0, 1}, {3, 3, 0}, {1, 1, -1}};
  GrowingHull hull(points);
  const std::vector<std::uint32_t> ring = {0, 1, 2};
  hull.start(ring, true);
  ASSERT_TRUE(hull.insert(3, kAnywhere));
  ASSERT_TRUE(hull.insert(4, kAnywhere));
  EXPECT_TRUE(hull.has(4));
  EXPECT_FALSE(hull.insert(5, kAnywhere));
}

TEST(GrowingHull_random_growth, rollback_restores_every_state) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> cell(0, 6);
  for (int round = 0; round < 200; ++round) {
    std::vector<PointF> points = {{-1, -1, -1}, {7, -1, -1}, {-1, 8, -1}};
    for (int i = 0; i < 25; ++i)
      points.push_back({static_cast<float>(cell(random)), static_cast<float>(cell(random)),
                        static_cast<float>(cell(random))});
    GrowingHull hull(points);
    const std::vector<std::uint32_t> ring = {0, 1, 2};
    hull.start(ring, false);
    std::vector<std::vector<Triangle>> states;
    std::vector<GrowingHull::Mark> marks;
    for (std::uint32_t v = 3; v < points.size(); ++v) {
      states.push_back(facets(hull));
      marks.push_back(hull.mark());
      ASSERT_TRUE(hull.insert(v, v - 1));
      expect_consistent(hull);
      if (v == 12) {
        hull.commit();
        states.clear();
        marks.clear();
      }
    }
    ASSERT_EQ(test::judge_hull(points, canonical_hull(points, hull.triangles()).mesh), "");
    while (!states.empty()) {
      hull.rollback(marks.back());
      ASSERT_EQ(facets(hull), states.back());
      expect_consistent(hull);
      states.pop_back();
      marks.pop_back();
    }
  }
}

}  // namespace
}  // namespace palpate::bake
