// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "decompose_shapes.hpp"
#include "host_bake/base/error.hpp"
#include "host_bake/mesh/mesh.hpp"
#include "host_bake/mesh/slivers.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {
namespace {

Mesh moved(Mesh mesh, double scale, Point offset) {
  for (Point& p : mesh.points)
    for (std::size_t i = 0; i < 3; ++i) p[i] = offset[i] + scale * p[i];
  return mesh;
}

double largest_norm(const NormalMesh& mesh) {
  double largest = 0;
  for (const auto& p : mesh.points)
    largest = std::max(largest, std::hypot(double(p[0]), double(p[1]), double(p[2])));
  return largest;
}

/// Half an ulp of a coordinate in [0.5, 1), in all three.
constexpr double kRounding = 6e-8;

TEST(Normalise_cube, centre_and_radius_of_the_circumsphere) {
  const NormalMesh mesh = normalise(moved(test::voxels({{0, 0, 0}}), 2, {10, 20, 30}));
  EXPECT_NEAR(mesh.radius_m, std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(mesh.centre_m[0], 11, 1e-13);
  EXPECT_NEAR(mesh.centre_m[1], 21, 1e-13);
  EXPECT_NEAR(mesh.centre_m[2], 31, 1e-13);
  EXPECT_NEAR(largest_norm(mesh), 1, kRounding);
}

TEST(Normalise_scales_from_1e_minus_9_to_1e9, unit_ball_and_back) {
  const Mesh shape = test::torus(12, 8, 0.3, 0.1, 1);
  for (const double scale : {1e-9, 1e-3, 1.0, 1e9}) {
    const Mesh mesh = moved(shape, scale, {3 * scale, -5 * scale, scale});
    const NormalMesh normal = normalise(mesh);
    EXPECT_LE(largest_norm(normal), 1 + kRounding);
    EXPECT_GE(largest_norm(normal), 1 - kRounding);
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(normal.centre_m[i] + normal.radius_m * double(normal.points[v][i]),
                    mesh.points[v][i], kRounding * normal.radius_m);
  }
}

TEST(Normalise_far_from_the_origin, same_shape_as_near_it) {
  // A power of two, and coordinates with few bits: the move itself does not round.
  const Mesh near = test::voxels({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {3, 5, 7}});
  const NormalMesh a = normalise(near);
  const NormalMesh b = normalise(moved(near, 1, {1048576, -1048576, 4194304}));
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t v = 0; v < a.points.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a.points[v][i], b.points[v][i], 1.2e-7);
  EXPECT_NEAR(a.radius_m, b.radius_m, 1e-12);
}

TEST(Normalise_smallest_sphere, no_box_centre) {
  // An obtuse triangle: the smallest sphere is about its longest side.
  Mesh mesh;
  mesh.points = {{-1, 0, 0}, {1, 0, 0}, {0.9, 0.3, 0}};
  mesh.faces = {{0, 1, 2}};
  const NormalMesh normal = normalise(mesh);
  EXPECT_NEAR(normal.radius_m, 1, 1e-14);
  EXPECT_NEAR(normal.centre_m[1], 0, 1e-14);
}

TEST(Normalise_unreferenced_vertices, do_not_count) {
  Mesh mesh = test::voxels({{0, 0, 0}});
  mesh.points.push_back({1e6, 0, 0});
  mesh.points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_NEAR(normalise(mesh).radius_m, std::sqrt(0.75), 1e-14);
}

TEST(Normalise_twice, same_bits) {
  const Mesh mesh = test::torus(40, 20, 0.4, 0.2, 3);
  const NormalMesh a = normalise(mesh);
  const NormalMesh b = normalise(mesh);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.radius_m, b.radius_m);
  EXPECT_EQ(a.centre_m, b.centre_m);
}

TEST(Normalise_nothing_to_measure, refused) {
  Mesh point;
  point.points = {{1, 1, 1}};
  point.faces = {{0, 0, 0}};
  Mesh infinite = test::voxels({{0, 0, 0}});
  infinite.points[0][1] = std::numeric_limits<double>::infinity();
  Mesh huge = test::voxels({{0, 0, 0}});
  for (Point& p : huge.points) p[0] = p[0] > 0 ? 1.7e308 : -1.7e308;
  EXPECT_THROW(normalise(Mesh{}), InputRefused);
  EXPECT_THROW(normalise(point), InputRefused);
  EXPECT_THROW(normalise(infinite), InputRefused);
  EXPECT_THROW(normalise(huge), InputRefused);
}

/// A cube of which one edge has a vertex in its middle on one side alone: a sliver closes the gap.
Mesh cube_with_a_sliver() {
  Mesh mesh = test::voxels({{0, 0, 0}});
  const Face split = mesh.faces[0];
  const Point& a = mesh.points[split[0]];
  const Point& b = mesh.points[split[1]];
  const auto middle = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.push_back({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2});
  mesh.faces[0] = {split[0], middle, split[2]};
  mesh.faces.push_back({middle, split[1], split[2]});
  mesh.faces.push_back({split[0], split[1], middle});
  return mesh;
}

double smallest_height(const NormalMesh& mesh) {
  double least = 1;
  for (const Face& f : mesh.faces) {
    const auto at = [&](std::size_t i) {
      const auto& p = mesh.points[f[i]];
      return Vec3d{double(p[0]), double(p[1]), double(p[2])};
    };
    const Vec3d ab = at(1) - at(0), ac = at(2) - at(0);
    least = std::min(least, norm(cross(ab, ac)) / std::max({norm(ab), norm(ac), norm(ac - ab)}));
  }
  return least;
}

TEST(Remove_slivers, gives_every_edge_two_normals) {
  const Mesh mesh = cube_with_a_sliver();
  EXPECT_GT(check(mesh).crossings, 0u);  // the vertex on its neighbour's edge
  NormalMesh normal = normalise(mesh);
  EXPECT_LT(smallest_height(normal), 1e-6);
  EXPECT_EQ(remove_slivers(normal), 1u);
  EXPECT_GT(smallest_height(normal), 0.1);
  const CheckReport after = check(Mesh{mesh.points, normal.faces});
  EXPECT_EQ(after.boundary_edges, 0u);
  EXPECT_EQ(after.components, 1u);
  EXPECT_EQ(after.crossings, 0u);
  EXPECT_EQ(remove_slivers(normal), 0u);
}

TEST(Remove_slivers, makes_one_vertex_of_two_that_nearly_coincide) {
  // A pyramid whose tip is an edge of no length.
  const Mesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5 + 1e-9, 1}},
      {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {3, 0, 4}}};
  NormalMesh normal = normalise(mesh);
  EXPECT_EQ(remove_slivers(normal), 2u);
  EXPECT_EQ(normal.faces.size(), 6u);
  EXPECT_GT(smallest_height(normal), 0.1);
  EXPECT_EQ(check(Mesh{mesh.points, normal.faces}).boundary_edges, 0u);
}

TEST(Remove_slivers, does_not_join_borders) {
  const Mesh mesh{{{0, -1, 0}, {0, 1, 0}, {0, 0, 0}, {1e-9, 0, 0}}, {{0, 3, 2}, {1, 2, 3}}};
  NormalMesh normal = normalise(mesh);
  EXPECT_EQ(remove_slivers(normal), 0u);
  EXPECT_EQ(normal.faces, mesh.faces);
}

TEST(Remove_slivers, leaves_other_meshes_alone) {
  const Mesh mesh = test::torus(12, 8, 0.3, 0.1, 1);
  NormalMesh normal = normalise(mesh);
  EXPECT_EQ(remove_slivers(normal), 0u);
  EXPECT_EQ(normal.faces, mesh.faces);
}

}  // namespace
}  // namespace palpate::bake
