// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host_bake/mesh/triangulate.hpp"
#include "mesh_support.hpp"

namespace palpate::bake::testing {
namespace {

/// Twice the signed area of a polygon or triangle seen from +z.
double area(const std::vector<Point>& points, std::span<const std::uint32_t> corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point &a = points[corners[i]], &b = points[corners[(i + 1) % corners.size()]];
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}

/// All triangles run round +z and together cover the polygon's area: no overlap, no gap.
void expect_covered(const std::vector<Point>& points, const std::vector<std::uint32_t>& polygon) {
  std::vector<Face> faces;
  triangulate(points, polygon, faces);
  ASSERT_EQ(faces.size(), polygon.size() - 2);
  double sum = 0;
  for (const Face& f : faces) {
    const double part = area(points, f);
    EXPECT_GT(part, 0);
    sum += part;
  }
  EXPECT_NEAR(sum, area(points, polygon), 1e-12 * std::abs(sum));
}

std::vector<std::uint32_t> count_up(std::size_t n) {
  std::vector<std::uint32_t> polygon(n);
  for (std::size_t i = 0; i < n; ++i) polygon[i] = static_cast<std::uint32_t>(i);
  return polygon;
}

TEST(Triangulate, Concave_quad_is_cut_inside) {
  const std::vector<Point> dart = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
  for (std::size_t first = 0; first < 4; ++first) {
    std::vector<std::uint32_t> polygon;
    for (std::size_t i = 0; i < 4; ++i)
      polygon.push_back(static_cast<std::uint32_t>((first + i) % 4));
    expect_covered(dart, polygon);
  }
}

TEST(Triangulate, Convex_quad_is_cut_from_its_first_corner_be_it_flat_or_not) {
  for (const double height : {0.0, 0.3, -0.3}) {
    const std::vector<Point> quad = {{0, 0, height}, {1, 0, 0}, {1, 1, height}, {0, 1, 0}};
    for (std::uint32_t first = 0; first < 4; ++first) {
      const std::uint32_t q[4] = {first, (first + 1) % 4, (first + 2) % 4, (first + 3) % 4};
      std::vector<Face> faces;
      triangulate(quad, q, faces);
      EXPECT_EQ(faces, (std::vector<Face>{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}));
    }
  }
}

TEST(Triangulate, Random_stars_are_covered) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.05, 1);
  for (std::size_t n = 5; n < 60; ++n) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      const double r = radius(random);
      points.push_back({r * std::cos(angle), r * std::sin(angle), 0.5});
    }
    expect_covered(points, count_up(n));
  }
}

TEST(Triangulate, Hole_behind_a_bridge_stays_open) {
  const std::vector<Point> points = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0},
                                     {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}};
  expect_covered(points, {0, 1, 2, 3, 0, 4, 5, 6, 7, 4});
}

TEST(Triangulate, Collinear_corners_are_kept) {
  const std::vector<Point> points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  expect_covered(points, count_up(5));
}

TEST(Triangulate, Plane_may_have_any_direction) {
  const std::vector<Point> flat = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Point> turned;
    for (const Point& p : flat) {
      Point q{};
      for (std::size_t i = 0; i < 3; ++i) q[(i + axis) % 3] = p[i];
      turned.push_back(q);
    }
    std::vector<Face> faces;
    triangulate(turned, count_up(5), faces);
    ASSERT_EQ(faces.size(), 3U);
    double sum = 0;
    for (const Face& f : faces) sum += area(flat, f);
    EXPECT_DOUBLE_EQ(sum, area(flat, count_up(5)));
  }
}

TEST(Triangulate, Hopeless_polygons_become_fans) {
  const std::vector<Point> points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}, {2, 9, 0}};
  std::vector<Face> faces;
  triangulate(points, count_up(5), faces);  // crosses itself
  EXPECT_EQ(faces, (std::vector<Face>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  faces.clear();
  triangulate(std::vector<Point>(5, Point{1, 1, 1}), count_up(5), faces);  // no plane
  EXPECT_EQ(faces.size(), 3U);
  faces.clear();
  triangulate(points, std::vector<std::uint32_t>{0, 0, 1, 1, 3, 3}, faces);  // repeats corners
  EXPECT_EQ(faces.size(), 4U);
}

}  // namespace
}  // namespace palpate::bake::testing
