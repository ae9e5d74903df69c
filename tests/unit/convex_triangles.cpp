// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "convex_shapes.hpp"
#include "rt_core/convex/support.hpp"
#include "tests/support/triangle_distance.hpp"

namespace palpate::convex::test {
namespace {

using Corners = Vec3d[3];
using palpate::test::triangle_distance;
using palpate::test::TriangleDistance;

/// Are the points on both triangles and as far apart as stated?
void expect_attained(const Corners& a, const Corners& b, const TriangleDistance& d) {
  const auto off = [](const Corners& t, Vec3d p) {
    const Corners at{p, p, p};
    return triangle_distance(t, at).distance;
  };
  ASSERT_NEAR(norm(d.point_a - d.point_b), d.distance, 1e-15);
  ASSERT_LE(off(a, d.point_a), 1e-7);
  ASSERT_LE(off(b, d.point_b), 1e-7);
}

/// A triangle as a hull, and its corners as the hull's floats have them.
struct Both {
  Shape shape;
  Corners corners;

  Both(Vec3d p, Vec3d q, Vec3d r) : shape(triangle(p, q, r)) {
    for (std::uint32_t k = 0; k < 3; ++k) corners[k] = position(shape.hull(), k);
  }
};

TEST(Triangles, corner_over_face_measures_the_height) {
  const Corners a{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Corners b{{0.2, 0.2, 0.3}, {0.2, 0.4, 1}, {0.4, 0.2, 1}};
  const TriangleDistance d = triangle_distance(a, b);
  EXPECT_NEAR(d.distance, 0.3, 1e-15);
  expect_attained(a, b, d);
}

TEST(Triangles, crossing_edges_measure_their_common_perpendicular) {
  const Corners a{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}};
  const Corners b{{0, -1, 0.25}, {0, 1, 0.25}, {0, 0, 1}};
  const TriangleDistance d = triangle_distance(a, b);
  EXPECT_NEAR(d.distance, 0.25, 1e-15);
  expect_attained(a, b, d);
}

TEST(Triangles, crossing_triangles_share_a_point) {
  const Corners a{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const Corners b{{0, 0, -1}, {0.1, 0, 1}, {-0.1, 0.1, 1}};
  const TriangleDistance d = triangle_distance(a, b);
  EXPECT_EQ(d.distance, 0);
  expect_attained(a, b, d);
  const TriangleDistance swapped = triangle_distance(b, a);
  EXPECT_EQ(swapped.distance, 0);
}

TEST(Triangles, one_in_the_plane_of_another) {
  const Corners a{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Corners inside{{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}};
  const Corners beside{{1.5, 0, 0}, {2, 0.5, 0}, {2, -0.5, 0}};
  const Corners overlapping{{0.2, 0.2, 0}, {2, 0.5, 0}, {2, -0.5, 0}};
  EXPECT_EQ(triangle_distance(a, inside).distance, 0);
  EXPECT_NEAR(triangle_distance(a, beside).distance, 0.5, 1e-15);
  EXPECT_NEAR(triangle_distance(a, overlapping).distance, 0, 1e-15);
}

TEST(Triangles, identical_ones_and_ones_with_a_common_edge_touch) {
  const Corners a{{0.1, 0.2, 0.3}, {1, 0.5, 0}, {0, 1, 0.7}};
  const Corners wing{{0.1, 0.2, 0.3}, {1, 0.5, 0}, {0, -1, 0.7}};
  EXPECT_NEAR(triangle_distance(a, a).distance, 0, 1e-15);
  EXPECT_NEAR(triangle_distance(a, wing).distance, 0, 1e-15);
}

TEST(Triangles, degenerate_ones_are_segments_and_points) {
  const Corners at{{0.25, 0.25, 2}, {0.25, 0.25, 2}, {0.25, 0.25, 2}};
  const Corners along{{0, -1, 1}, {0, 0, 1}, {0, 1, 1}};
  const Corners a{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  EXPECT_NEAR(triangle_distance(a, at).distance, 2, 1e-15);
  EXPECT_NEAR(triangle_distance(a, along).distance, 1, 1e-15);
  EXPECT_NEAR(triangle_distance(at, along).distance, std::sqrt(1 + 0.0625), 1e-15);
  EXPECT_EQ(triangle_distance(at, at).distance, 0);
}

TEST(Triangles, random_ones_agree_with_hulls) {
  Random random(1);
  int crossing = 0;
  for (int i = 0; i < 200000; ++i) {
    const double size = std::pow(10.0, uniform(random, -6, 0));
    const Vec3d base = uniform(random, 0, 0.3) * random_unit(random);
    const double reach = 0.4 * std::pow(10.0, uniform(random, -3, 0));
    const Vec3d p = 0.4 * size * random_unit(random);
    const Vec3d q = 0.4 * random_unit(random);
    const bool sliver = (random() % 4) == 0;
    const Both a(p, q, sliver ? q + size * (q - p) : 0.4 * random_unit(random));
    const Both b(base + reach * random_unit(random), base + reach * random_unit(random),
                 base + reach * random_unit(random));
    const TriangleDistance d = triangle_distance(a.corners, b.corners);
    expect_attained(a.corners, b.corners, d);
    Cache cache;
    const Distance h = distance(a.shape.hull(), b.shape.hull(), {}, kExact, cache);
    ASSERT_LE(h.lower_bound, d.distance + 1e-14);
    ASSERT_LE(d.distance, h.distance + 2e-9);
    crossing += d.distance == 0 ? 1 : 0;
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(crossing, 2000);
}

}  // namespace
}  // namespace palpate::convex::test
