// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "bake_support.hpp"
#include "host_bake/hierarchy/merge.hpp"
#include "host_bake/metrics/culling.hpp"
#include "host_bake/metrics/hausdorff.hpp"
#include "host_bake/metrics/hull_side.hpp"
#include "host_bake/metrics/sphere.hpp"
#include "host_bake/metrics/support_area.hpp"
#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

std::vector<PointF> random_points(std::size_t count, float spread, std::mt19937_64& random) {
  std::uniform_real_distribution<float> at(-spread, spread);
  std::vector<PointF> points(count);
  for (PointF& p : points) p = {at(random), at(random), at(random)};
  return points;
}

bool inside_in_float(const Sphere& s, const PointF& p) {
  const float x = p[0] - s.centre[0], y = p[1] - s.centre[1], z = p[2] - s.centre[2];
  return std::sqrt(x * x + y * y + z * z) <= s.radius;
}

TEST(BoundingSphere, Contains_every_point_in_float_arithmetic_too) {
  std::mt19937_64 random(7);
  for (const float spread : {1e-6f, 1e-3f, 0.5f}) {
    for (std::size_t count = 1; count < 60; ++count) {
      std::vector<PointF> points = random_points(count, spread, random);
      for (PointF& p : points) p[0] += 0.4f;  // off the centre, where floats are coarse
      const Sphere sphere = bounding_sphere(points);
      for (const PointF& p : points)
        EXPECT_TRUE(inside_in_float(sphere, p)) << spread << " " << count;
    }
  }
}

TEST(BoundingSphere, Is_the_smallest_one) {
  const Sphere segment =
      bounding_sphere(std::vector<PointF>{{-0.5f, 0, 0}, {0.5f, 0, 0}, {0.1f, 0.2f, 0}});
  EXPECT_NEAR(segment.radius, 0.5, 1e-6);
  std::vector<PointF> cube;
  for (const float x : {0.f, 0.5f}) {
    for (const float y : {0.f, 0.5f}) {
      for (const float z : {0.f, 0.5f}) cube.push_back({x, y, z});
    }
  }
  EXPECT_NEAR(bounding_sphere(cube).radius, 0.25 * std::sqrt(3.0), 1e-6);
}

TEST(BoundingSphere, Repeated_and_single_points) {
  EXPECT_EQ(bounding_sphere(std::vector<PointF>{{0.25f, 0, 0}}).radius, 0);
  EXPECT_EQ(bounding_sphere(std::vector<PointF>(5, {0.25f, 0, 0})).radius, 0);
}

NormalMesh unscaled(const std::vector<PointF>& points, const std::vector<Face>& faces) {
  return {points, faces, {}, 1};
}

// A pyramid with its tip at height h over the corners of a square of half diagonal 1; no floor.
NormalMesh pyramid(float h) {
  return unscaled({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, h}},
                  {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
}

float tip_support(float h, double delta) {
  const NormalMesh mesh = pyramid(h);
  return support_areas(mesh, vertex_normals(mesh), delta)[4];
}

TEST(SupportArea, Flat_vertex_has_all_of_its_faces) {
  const NormalMesh mesh = normalise(testing::sheet(4));
  const std::vector<float> areas = support_areas(mesh, vertex_normals(mesh), 0.01);
  const double cell = 1 / mesh.radius_m;
  EXPECT_NEAR(*std::max_element(areas.begin(), areas.end()), 3 * cell * cell, 1e-6);
}

TEST(SupportArea, Tip_loses_what_is_beyond_delta) {
  EXPECT_NEAR(tip_support(0.5f, 1), 2, 1e-6);  // the whole square
  EXPECT_NEAR(tip_support(0.5f, 0.5), 2, 1e-6);
  EXPECT_NEAR(tip_support(0.5f, 0.25), 0.5, 1e-6);
  EXPECT_NEAR(tip_support(0.5f, 0.1), 0.08, 1e-6);
}

// Oracle: the share of points of the triangle that lie within delta, counted.
TEST(SupportArea, Face_cut_at_delta_agrees_with_counting) {
  const NormalMesh mesh = unscaled({{0, 0, 0}, {1, 0, 0.3f}, {0, 1, -0.2f}}, {{0, 1, 2}});
  const std::vector<Vec3d> normals(3, Vec3d{0, 0, 1});
  for (const double delta : {0.02, 0.15, 0.25, 0.5}) {
    constexpr int kSteps = 2000;
    int within = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; i + j < kSteps; ++j) {
        const double u = (i + 1.0 / 3) / kSteps, v = (j + 1.0 / 3) / kSteps;
        within += std::abs(0.3 * u - 0.2 * v) <= delta ? 1 : 0;
      }
    }
    const double counted = 0.5 * within / (0.5 * kSteps * kSteps);
    EXPECT_NEAR(support_areas(mesh, normals, delta)[0], counted, 2e-3) << delta;
  }
}

TEST(SupportArea, Never_below_its_floor) {
  const NormalMesh needle = pyramid(50);
  const std::vector<float> areas = support_areas(needle, vertex_normals(needle), 1e-6);
  EXPECT_GT(*std::min_element(areas.begin(), areas.end()), 0.01f);
}

TEST(FinestResolution, Sheet_has_that_of_its_cell) {
  const NormalMesh mesh = normalise(testing::sheet(4));
  EXPECT_NEAR(finest_resolution(mesh, vertex_normals(mesh)), mesh.radius_m, 1e-5);
}

TEST(FinestResolution, Edge_without_projected_length_stays_finite) {
  const NormalMesh mesh = unscaled({{0, 0, 0}, {1e-20f, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_NEAR(finest_resolution(mesh, vertex_normals(mesh)), 1e7, 10);
}

constexpr std::array<PointF, 8> kBox{{{-0.5f, -0.25f, -0.125f},
                                      {0.5f, -0.25f, -0.125f},
                                      {-0.5f, 0.25f, -0.125f},
                                      {0.5f, 0.25f, -0.125f},
                                      {-0.5f, -0.25f, 0.125f},
                                      {0.5f, -0.25f, 0.125f},
                                      {-0.5f, 0.25f, 0.125f},
                                      {0.5f, 0.25f, 0.125f}}};

double distance_to_box(const PointF& p) {
  const Vec3d q = vec(p);
  const Vec3d d{std::max(std::abs(q.x) - 0.5, 0.0), std::max(std::abs(q.y) - 0.25, 0.0),
                std::max(std::abs(q.z) - 0.125, 0.0)};
  return norm(d);
}

TEST(HullSide, Box_distances_agree_with_the_formula) {
  const HullMesh hull = convex_hull(kBox);
  const HullSide side(kBox, hull.faces, hull.dimension);
  std::mt19937_64 random(3);
  for (const PointF& p : random_points(2000, 0.9f, random)) {
    EXPECT_NEAR(side.distance(p), distance_to_box(p), 1e-12);
    EXPECT_EQ(side.contains(p), distance_to_box(p) == 0);
  }
}

TEST(HullSide, Surface_is_in_and_one_step_off_it_is_out) {
  const HullMesh hull = convex_hull(kBox);
  const HullSide side(kBox, hull.faces, hull.dimension);
  EXPECT_TRUE(side.contains(kBox[3]));
  EXPECT_TRUE(side.contains({0.1f, 0.2f, 0.125f}));
  EXPECT_FALSE(side.contains({0.1f, 0.2f, std::nextafter(0.125f, 1.0f)}));
}

TEST(HullSide, Flat_and_straight_hulls) {
  const std::array<PointF, 3> triangle{{{0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}}};
  const std::array<std::array<std::uint32_t, 3>, 2> faces{{{0, 1, 2}, {0, 2, 1}}};
  const HullSide flat(triangle, faces, 2);
  EXPECT_TRUE(flat.contains({0.25f, 0.25f, 0}));
  EXPECT_FALSE(flat.contains({0.25f, 0.25f, 1e-30f}));
  EXPECT_NEAR(flat.distance({0.1f, 0.1f, -0.3f}), 0.3, 1e-7);
  const std::array<PointF, 2> segment{{{0, 0, 0}, {0.5f, 0, 0}}};
  const HullSide straight(segment, {}, 1);
  EXPECT_EQ(straight.distance({0.25f, 0, 0}), 0);
  EXPECT_NEAR(straight.distance({0.75f, 0, 0.25f}), std::sqrt(0.125), 1e-12);
}

TEST(Hausdorff, Merged_hulls_enclose_exactly) {
  Hierarchy tree = testing::triangle_tree(testing::dented_sphere());
  merge_to_root(tree, {});
  for (const float h : hausdorff_bounds(tree)) EXPECT_EQ(h, 0);
}

// Three triangles one over the other, 0.1 apart, each the parent of the one below.
Hierarchy stack_of_triangles() {
  Hierarchy tree;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const float z = 0.1f * static_cast<float>(i);
    tree.points.insert(tree.points.end(), {{0, 0, z}, {0.5f, 0, z}, {0, 0.5f, z}});
    TreePiece piece;
    piece.level = i;
    piece.parent = i < 2 ? i + 1 : image::kNone;
    if (i > 0) piece.children = {i - 1};
    if (i > 0) piece.enclosing = {0, 1, 2};
    piece.vertices = {3 * i, 3 * i + 1, 3 * i + 2};
    piece.hull_vertices = 3;
    piece.dimension = 2;
    piece.hull_faces = {{0, 1, 2}, {0, 2, 1}};
    tree.pieces.push_back(piece);
  }
  return tree;
}

TEST(Hausdorff, Is_that_of_the_original_surface) {
  const std::vector<float> h = hausdorff_bounds(stack_of_triangles());
  EXPECT_EQ(h[0], 0);
  EXPECT_NEAR(h[1], 0.1, 1e-6);
  EXPECT_NEAR(h[2], 0.2, 1e-6);
  EXPECT_GE(h[1], 0.1f);
}

TEST(Culling, Few_points_are_taken_as_they_are) {
  const Hierarchy tree = stack_of_triangles();
  const auto bounds = culling_bounds(tree, hausdorff_bounds(tree));
  EXPECT_TRUE(bounds[0].points.empty());
  EXPECT_EQ(bounds[2].points, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(bounds[2].residual, 0);
}

TEST(Culling, Own_hull_serves_where_nothing_is_outside) {
  const Hierarchy tree = stack_of_triangles();
  for (const CullingBound& bound : culling_bounds(tree, {0, 0, 0})) {
    EXPECT_TRUE(bound.points.empty());
    EXPECT_EQ(bound.residual, 0);
  }
}

// Flat, straight and round sets of several hundred extreme points.
TEST(Culling, Reduced_hull_and_residual_hold_all_points) {
  std::mt19937_64 random(11);
  for (const float flat : {1.0f, 1e-2f, 1e-6f, 0.0f}) {
    std::vector<PointF> points = random_points(600, 1, random);
    for (PointF& p : points) {
      const double length = norm(vec(p));
      for (float& c : p) c = static_cast<float>(0.9 * static_cast<double>(c) / length);
      p[2] *= flat;
    }
    Hierarchy tree;
    tree.points = points;
    TreePiece piece;
    piece.enclosing = convex_hull(points).vertices;
    tree.pieces.push_back(piece);
    const CullingBound bound = culling_bounds(tree, {4.0f})[0];
    ASSERT_GE(bound.points.size(), 3u);
    EXPECT_LE(bound.points.size(), image::kMaxCullingVertices);
    const std::vector<PointF> kept = positions(tree, bound.points);
    const HullMesh hull = convex_hull(kept);
    EXPECT_EQ(hull.vertices.size(), kept.size()) << flat;
    const HullSide side(kept, hull.faces, hull.dimension);
    for (const PointF& p : points)
      EXPECT_LE(side.distance(p), static_cast<double>(bound.residual)) << flat;
    EXPECT_LT(bound.residual, 0.25f) << flat;
  }
}

}  // namespace
}  // namespace palpate::bake
