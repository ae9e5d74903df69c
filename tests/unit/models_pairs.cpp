// SPDX-License-Identifier: GPL-3.0-or-later
// Models that belong together: one frame, interlocking, 0.2 to 1 % of the radius apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "host_bake/models/models.hpp"
#include "tests/unit/models_geometry.hpp"

namespace palpate {
namespace {

using bake::make_model;
using bake::Mesh;
using bake::Point;

struct PairNames {
  const char* inner;
  const char* outer;
};

class Pair : public testing::TestWithParam<PairNames> {
 protected:
  static void expect_apart(std::size_t inner_triangles, std::size_t outer_triangles,
                           std::uint64_t seed) {
    SCOPED_TRACE(std::to_string(inner_triangles) + " against " + std::to_string(outer_triangles));
    const Mesh inner = make_model(GetParam().inner, inner_triangles, seed);
    const Mesh outer = make_model(GetParam().outer, outer_triangles, seed);
    const test::Clearance c = test::clearance(inner, outer);
    EXPECT_EQ(c.crossings, 0U);
    for (const Mesh& mesh : {inner, outer}) {
      EXPECT_GE(c.least_m, 0.002 * test::radius_m(mesh));
      EXPECT_LE(c.least_m, 0.010 * test::radius_m(mesh));
    }
  }
};

TEST_P(Pair, equal_counts_keep_the_clearance) {
  for (const std::size_t triangles : {1000U, 1313U, 2222U, 6000U}) {
    expect_apart(triangles, triangles, 1);
  }
}

TEST_P(Pair, any_seed_keeps_the_clearance) {
  for (const std::uint64_t seed : {2ULL, 3ULL, 4ULL}) expect_apart(1800, 1800, seed);
}

TEST_P(Pair, unequal_fine_counts_keep_the_clearance) { expect_apart(27000, 20000, 1); }

TEST_P(Pair, cannot_be_pulled_straight_apart) {
  // Moved by 5 % of the radius the two touch, in some directions at least: they interlock.
  const Mesh inner = make_model(GetParam().inner, 3000);
  const Mesh outer = make_model(GetParam().outer, 3000);
  const double step = 0.05 * test::radius_m(inner);
  for (const Point direction : {Point{1, 0, 0}, Point{-1, 0, 0}, Point{0, 1, 0}, Point{0, -1, 0}}) {
    Mesh moved = inner;
    for (Point& p : moved.points) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += step * direction[k];
    }
    EXPECT_GT(test::clearance(moved, outer).crossings, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(all, Pair,
                         testing::Values(PairNames{"golf_ball", "golf_shell"},
                                         PairNames{"ball_joint_head", "ball_joint_cup"},
                                         PairNames{"jaw_lower", "jaw_upper"},
                                         PairNames{"screw", "nut"}),
                         [](const auto& pair) { return std::string(pair.param.inner); });

TEST(Jaws, teeth_overlap_in_height) {
  double lower_top = -1.0;
  double upper_bottom = 1.0;
  for (const Point& p : make_model("jaw_lower").points) lower_top = std::max(lower_top, p[2]);
  for (const Point& p : make_model("jaw_upper").points) {
    upper_bottom = std::min(upper_bottom, p[2]);
  }
  EXPECT_GT(lower_top - upper_bottom, 0.003);
}

TEST(Nut, turns_on_the_screw_along_its_thread) {
  // A quarter turn with a quarter of the pitch keeps the two apart; a quarter turn alone does not.
  const Mesh screw = make_model("screw", 20000);
  const auto turned = [](double lift_m) {
    Mesh nut = make_model("nut", 20000);
    for (Point& p : nut.points) p = {-p[1], p[0], p[2] + lift_m};
    return nut;
  };
  EXPECT_EQ(test::clearance(screw, turned(0.0005)).crossings, 0U);
  EXPECT_GT(test::clearance(screw, turned(0.0)).crossings, 0U);
}

}  // namespace
}  // namespace palpate
