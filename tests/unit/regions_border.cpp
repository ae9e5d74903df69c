// SPDX-License-Identifier: Apache-2.0
// Triangles that meet in a point, and how the distance falls across the borders of regions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "rt_core/regions/around.hpp"
#include "rt_core/regions/border.hpp"

namespace palpate::regions {
namespace {

using image::kNone;
using image::RegionTriangle;
using Corners = std::array<std::uint32_t, 3>;

/// The cube from -1 to 1; each side is a region of its own, of two triangles.
class Cube {
 public:
  explicit Cube(std::size_t triangles = 12)
      : Cube(std::vector<Corners>(kTriangles.begin(), kTriangles.begin() + triangles), {}) {}

  /// Corner 8 is where corner 0 is: between them two triangles of no area, 12 and 13, along the
  /// edges from there to corners 1 and 2.
  static Cube with_needles() {
    std::vector<Corners> t(kTriangles.begin(), kTriangles.end());
    t[0][0] = t[1][0] = 8;
    t.push_back({2, 8, 0});
    t.push_back({8, 1, 0});
    return {t, {-1, -1, -1}};
  }
  /// Corner 8 is in the middle of the edge from corner 0 to 2, where a triangle of no area, 13,
  /// lies between the lower side and the two triangles 9 and 12 of the wall.
  static Cube with_cap() {
    std::vector<Corners> t(kTriangles.begin(), kTriangles.end());
    t[9] = {0, 6, 8};
    t.push_back({8, 6, 2});
    t.push_back({2, 0, 8});
    return {t, {-1, 0, -1}};
  }

  /// The triangles around a point, without `triangle` itself.
  std::multiset<std::uint32_t> around(std::uint32_t triangle, Vec3d point) const {
    std::multiset<std::uint32_t> found;
    visit_around(view, foot_at(view, triangle, point), point,
                 [&](const Sector& s) { found.insert(s.triangle); });
    return found;
  }

  ImageView view;

 private:
  static constexpr std::array<Corners, 12> kTriangles{{{0, 2, 3},
                                                       {0, 3, 1},
                                                       {4, 5, 7},
                                                       {4, 7, 6},
                                                       {0, 1, 5},
                                                       {0, 5, 4},
                                                       {2, 6, 7},
                                                       {2, 7, 3},
                                                       {0, 4, 6},
                                                       {0, 6, 2},
                                                       {1, 3, 7},
                                                       {1, 7, 5}}};

  Cube(const std::vector<Corners>& triangles, Vec3f eighth) {
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      RegionTriangle t{};
      t.region = i / 2;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t at = triangles[i][c];
        const Vec3f p = at == 8
                            ? eighth
                            : Vec3f{(at & 1u) != 0 ? 1.0f : -1.0f, (at & 2u) != 0 ? 1.0f : -1.0f,
                                    (at & 4u) != 0 ? 1.0f : -1.0f};
        t.corners[3 * c] = p.x;
        t.corners[3 * c + 1] = p.y;
        t.corners[3 * c + 2] = p.z;
        t.neighbours[c] = kNone;
        for (std::uint32_t j = 0; j < triangles.size(); ++j) {
          for (std::uint32_t e = 0; e < 3; ++e) {
            if (triangles[j][e] == triangles[i][(c + 1) % 3] &&
                triangles[j][(e + 1) % 3] == triangles[i][c]) {
              t.neighbours[c] = j;
            }
          }
        }
      }
      triangles_.push_back(t);
    }
    view.region_triangles = triangles_;
  }

  std::vector<RegionTriangle> triangles_;
};

/// z = -1 is the side of triangles 0 and 1.
constexpr std::uint32_t kBelow = 0;

Place below(const Cube& cube, Vec3d point) { return {cube.view, kBelow, point}; }

TEST(RegionsBorder, nothing_else_holds_a_point_inside_a_triangle) {
  EXPECT_TRUE(Cube().around(kBelow, {-0.5, 0.5, -1}).empty());
}

TEST(RegionsBorder, one_triangle_is_across_an_edge) {
  EXPECT_EQ(Cube().around(kBelow, {0, 0, -1}), (std::multiset<std::uint32_t>{1}));
  EXPECT_EQ(Cube().around(kBelow, {-1, 0.3, -1}), (std::multiset<std::uint32_t>{9}));
}

TEST(RegionsBorder, all_triangles_around_a_corner_are_found_once) {
  EXPECT_EQ(Cube().around(kBelow, {-1, -1, -1}), (std::multiset<std::uint32_t>{1, 4, 5, 8, 9}));
  EXPECT_EQ(Cube().around(kBelow, {-1, 1, -1}), (std::multiset<std::uint32_t>{6, 7, 9}));
}

TEST(RegionsBorder, around_a_corner_of_an_open_surface_both_ways_are_gone) {
  const Cube open(9);  // without triangle 9 and the side x = 1
  EXPECT_EQ(open.around(kBelow, {-1, -1, -1}), (std::multiset<std::uint32_t>{1, 4, 5, 8}));
  EXPECT_EQ(open.around(5, {-1, -1, -1}), (std::multiset<std::uint32_t>{0, 1, 4, 8}));
}

TEST(RegionsBorder, triangles_of_no_area_are_gone_over) {
  const Cube cube = Cube::with_needles();
  const Vec3d on_edge{-1, 0.3, -1};
  const Vec3d at_corner{-1, -1, -1};
  EXPECT_EQ(cube.around(kBelow, on_edge), (std::multiset<std::uint32_t>{9}));
  EXPECT_EQ(cube.around(9, on_edge), (std::multiset<std::uint32_t>{kBelow}));
  EXPECT_EQ(cube.around(kBelow, at_corner), (std::multiset<std::uint32_t>{1, 4, 5, 8, 9}));
  EXPECT_EQ(cube.around(5, at_corner), (std::multiset<std::uint32_t>{0, 1, 4, 8, 9}));
  // What lies on one of them lies on what is beside it.
  const std::uint32_t beside = foot_at(cube.view, 12, on_edge).triangle;
  EXPECT_TRUE(beside == kBelow || beside == 9);
  EXPECT_EQ(cube.around(12, on_edge), (std::multiset<std::uint32_t>{beside == 9 ? kBelow : 9}));
  EXPECT_EQ(cube.around(13, at_corner).size(), 5u);
}

TEST(RegionsBorder, edges_that_end_in_the_middle_of_another_are_gone_over) {
  const Cube cube = Cube::with_cap();
  EXPECT_EQ(cube.around(kBelow, {-1, 0.3, -1}), (std::multiset<std::uint32_t>{12}));
  EXPECT_EQ(cube.around(kBelow, {-1, -0.3, -1}), (std::multiset<std::uint32_t>{9}));
  EXPECT_EQ(cube.around(9, {-1, 0, -1}), (std::multiset<std::uint32_t>{kBelow, 12}));
  EXPECT_EQ(cube.around(12, {-1, 0, -1}), (std::multiset<std::uint32_t>{kBelow, 9}));
  EXPECT_EQ(cube.around(kBelow, {-1, -1, -1}), (std::multiset<std::uint32_t>{1, 4, 5, 8, 9}));
}

TEST(RegionsBorder, surface_without_faces_has_nothing_around) {
  // Three triangles of no area across each other's edges: the way over them goes round.
  Cube cube;
  std::vector<RegionTriangle> flat(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) flat[i].neighbours[k] = (i + 1) % 3;
    flat[i].corners[0] = 1;
  }
  cube.view.region_triangles = flat;
  EXPECT_TRUE(cube.around(0, {0.5, 0, 0}).empty());
  EXPECT_EQ(foot_at(cube.view, 0, {0.5, 0, 0}).triangle, 0u);
}

TEST(RegionsBorder, sectors_lead_counter_clockwise_over_their_triangles) {
  const Cube cube;
  for (const Vec3d point : {Vec3d{-1, -1, -1}, Vec3d{-1, 0.3, -1}}) {
    visit_around(cube.view, foot_at(cube.view, kBelow, point), point, [&](const Sector& s) {
      const Vec3d normal = normal_of(cube.view.region_triangles[s.triangle]);
      EXPECT_NEAR(dot(s.from, normal), 0, 1e-12);
      EXPECT_NEAR(dot(s.to, normal), 0, 1e-12);
      EXPECT_GE(dot(cross(s.from, s.to), normal), 0);
    });
  }
}

TEST(RegionsBorder, distance_falls_across_an_edge_by_the_sine_of_the_lean) {
  const Cube cube;
  const double lean = 0.3;
  // From a point beside the cube's lower edge at x = -1, above that edge.
  const Fall fall = fall_across(below(cube, {-1, 0.3, -1}), {std::cos(lean), 0, -std::sin(lean)});
  EXPECT_NEAR(fall.rate, std::sin(lean), 1e-12);
  EXPECT_EQ(fall.region, cube.view.region_triangles[9].region);
}

TEST(RegionsBorder, distance_does_not_fall_where_the_point_is_the_nearest_of_all) {
  const Cube cube;
  const Vec3d beside{std::sqrt(0.5), 0, std::sqrt(0.5)};
  EXPECT_EQ(fall_across(below(cube, {-1, 0.3, -1}), beside).rate, 0);
  EXPECT_EQ(fall_across(below(cube, {-1, 0.3, -1}), {0, 0, 1}).rate, 0);
  const double third = std::sqrt(1.0 / 3);
  EXPECT_EQ(fall_across(below(cube, {-1, -1, -1}), {third, third, third}).rate, 0);
}

TEST(RegionsBorder, steepest_way_around_a_corner_tells) {
  const Cube cube;
  // The nearest of the lower side is its corner; the edge up from there leads nearer, and over the
  // two walls nothing does sooner.
  const Vec3d up{0.48, 0.6, -0.64};
  const Fall fall = fall_across(below(cube, {-1, -1, -1}), up);
  EXPECT_NEAR(fall.rate, 0.64, 1e-12);
  // Over the wall at y = -1 it leads nearer still.
  const Vec3d aside{-0.48, 0.6, -0.64};
  const Fall on_wall = fall_across(below(cube, {-1, -1, -1}), aside);
  EXPECT_NEAR(on_wall.rate, 0.8, 1e-12);
  EXPECT_EQ(on_wall.region, cube.view.region_triangles[4].region);
}

TEST(RegionsBorder, own_region_is_no_border) {
  // Across the diagonal the same side goes on.
  EXPECT_EQ(fall_across(below(Cube(), {0, 0, -1}), {-0.6, 0.8, 0}).rate, 0);
}

// Two such cubes, the edges between their sides x = -1 and z = -1 across each other.
constexpr Vec3d kOnEdge{-1, 0.3, -1};
const double kHalf = std::sqrt(0.5);
/// From b to a: the middle of the normals of a's edge, inwards.
const Vec3d kUp{kHalf, 0, kHalf};

/// The edge of b, in the coordinates of a, at an angle to that of a.
Vec3d edge_of_b(double angle) {
  return {-kHalf * std::sin(angle), std::cos(angle), kHalf * std::sin(angle)};
}

/// The middle of the normals of b's edge leans from kUp by `lean`.
Mat3d across_a(double angle, double lean) {
  const Vec3d edge = edge_of_b(angle);
  const Vec3d middle = std::cos(lean) * kUp + std::sin(lean) * cross(edge, kUp);
  const Vec3d along{0, 1, 0};
  const Vec3d outwards{-kHalf, 0, -kHalf};
  return transpose(Mat3d{edge, middle, cross(edge, middle)}) *
         Mat3d{along, outwards, cross(along, outwards)};
}

TEST(RegionsBorder, normal_where_edges_cross_is_square_to_both) {
  const Cube cube;
  constexpr double kLean = 0.3;
  for (const double angle : {std::numbers::pi / 2, std::numbers::pi / 3, std::numbers::pi / 4}) {
    SCOPED_TRACE(angle);
    const Vec3d leaning = std::cos(kLean) * kUp + std::sin(kLean) * cross(edge_of_b(angle), kUp);
    const Vec3d found =
        common_normal(below(cube, kOnEdge), below(cube, kOnEdge), across_a(angle, 0), leaning);
    EXPECT_NEAR(norm(found), 1, 1e-12);
    EXPECT_NEAR(dot(found, edge_of_b(angle)), 0, 1e-12);
    EXPECT_LE(norm(found - kUp), std::tan(kLean) * std::pow(std::cos(angle), 16) + 1e-12);
  }
}

TEST(RegionsBorder, normal_stays_one_of_the_other_surface) {
  const Cube cube;
  const double quarter = std::numbers::pi / 2;
  // b's edge has no normal nearer to kUp than that of one of its sides.
  const Mat3d b_in_a = across_a(quarter, 1.0);
  const Vec3d leaning = b_in_a * Vec3d{-std::sin(0.2), 0, -std::cos(0.2)};
  const Vec3d on_edge = common_normal(below(cube, kOnEdge), below(cube, kOnEdge), b_in_a, leaning);
  const Vec3d side = b_in_a * Vec3d{0, 0, -1};
  const Vec3d wall = b_in_a * Vec3d{-1, 0, 0};
  const Vec3d nearest = dot(side, kUp) > dot(wall, kUp) ? side : wall;
  EXPECT_LT(norm(on_edge - nearest), 1e-3);
  // A corner's are between those of three sides.
  const Vec3d on_corner =
      transpose(b_in_a) *
      common_normal(below(cube, kOnEdge), below(cube, {-1, -1, -1}), b_in_a, leaning);
  for (const double outwards : {-on_corner.x, -on_corner.y, -on_corner.z}) {
    EXPECT_GE(outwards, -1e-9);
  }
}

// Beside surfaces that cross, a corner may be seen from within, where all ways over it lead on.
TEST(RegionsBorder, normal_does_not_turn_round) {
  const Cube cube;
  const Place corner = below(cube, {-1, -1, -1});
  std::mt19937 rng(1);
  std::normal_distribution<double> gauss;
  const auto random_unit = [&] {
    const Vec3d v{gauss(rng), gauss(rng), gauss(rng)};
    return (1 / norm(v)) * v;
  };
  const Mat3d as_it_is{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 1000; ++i) {
    const Vec3d normal = random_unit();
    const Vec3d found = common_normal(corner, corner, as_it_is, normal);
    EXPECT_NEAR(norm(found), 1, 1e-12);
    EXPECT_GE(dot(found, normal), 0.5 - 1e-12);
  }
}

TEST(RegionsBorder, normal_on_a_face_is_that_of_the_face) {
  const Cube cube;
  const Mat3d b_in_a = across_a(1.0, 0);
  const Vec3d normal = b_in_a * Vec3d{0, 0, -1};
  const Place face = below(cube, {-0.5, 0.5, -1});
  EXPECT_EQ(norm(common_normal(below(cube, kOnEdge), face, b_in_a, normal) - normal), 0);
  EXPECT_EQ(norm(common_normal(face, below(cube, kOnEdge), b_in_a, kUp) - kUp), 0);
}

}  // namespace
}  // namespace palpate::regions
