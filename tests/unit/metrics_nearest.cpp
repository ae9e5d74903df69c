// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/nearest.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "decompose_shapes.hpp"
#include "host_bake/metrics/nearest_on_triangle.hpp"

namespace palpate::bake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

Kernel::Point_3 cgal_point(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

Triangles triangles_of(const NormalMesh& mesh) {
  Triangles triangles;
  for (const Face& f : mesh.faces) {
    triangles.emplace_back(cgal_point(mesh.points[f[0]]), cgal_point(mesh.points[f[1]]),
                           cgal_point(mesh.points[f[2]]));
  }
  return triangles;
}

std::vector<Vec3d> random_points(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> at(-1.1, 1.1);
  std::vector<Vec3d> points(count);
  for (Vec3d& p : points) p = {at(random), at(random), at(random)};
  return points;
}

NormalMesh rough_torus() { return normalise(test::torus(60, 30, 0.4, 0.05, 5)); }

TEST(NearestSurface, Distances_agree_with_CGALs_tree) {
  const NormalMesh mesh = rough_torus();
  const Triangles triangles = triangles_of(mesh);
  const Tree tree(triangles.begin(), triangles.end());
  const NearestSurface surface(mesh);
  for (const Vec3d& p : random_points(3000, 1)) {
    EXPECT_NEAR(std::sqrt(surface.nearest(p).squared_distance),
                std::sqrt(tree.squared_distance({p.x, p.y, p.z})), 1e-14);
  }
}

TEST(NearestSurface, Hint_never_changes_the_result) {
  const NormalMesh mesh = rough_torus();
  const NearestSurface surface(mesh);
  std::vector<Vec3d> points = random_points(500, 2);
  // Vertices are as near to all triangles around them: ties.
  for (std::size_t v = 0; v < mesh.points.size(); v += 7) points.push_back(vec(mesh.points[v]));
  for (const Vec3d& p : points) {
    const Nearest plain = surface.nearest(p);
    for (const std::uint32_t hint : {0u, 17u, plain.triangle, 3599u}) {
      const Nearest hinted = surface.nearest(p, hint);
      EXPECT_EQ(hinted.triangle, plain.triangle);
      EXPECT_EQ(hinted.squared_distance, plain.squared_distance);
    }
  }
}

TEST(NearestSurface, Any_number_of_triangles) {
  const NormalMesh torus = rough_torus();
  for (std::size_t count = 1; count <= 600; count += count < 80 ? 1 : 37) {
    NormalMesh mesh = torus;
    mesh.faces.resize(count);
    const NearestSurface surface(mesh);
    for (const Vec3d& p : random_points(20, count)) {
      double least = std::numeric_limits<double>::infinity();
      for (std::uint32_t t = 0; t < count; ++t)
        least = std::min(least, surface.squared_distance(p, t));
      EXPECT_EQ(surface.nearest(p).squared_distance, least) << count;
    }
  }
}

TEST(NearestSurface, Neighbours_share_the_side) {
  const NearestSurface surface(rough_torus());
  for (std::uint32_t t = 0; t < 3600; ++t) {
    const auto mine = surface.corners(t);
    for (std::size_t side = 0; side < 3; ++side) {
      const auto other = surface.corners(surface.neighbour(t, side));
      EXPECT_EQ(std::count(other.begin(), other.end(), mine[side]), 1);
      EXPECT_EQ(std::count(other.begin(), other.end(), mine[(side + 1) % 3]), 1);
      EXPECT_EQ(std::count(other.begin(), other.end(), mine[(side + 2) % 3]), 0);
    }
  }
}

TEST(NearestSurface, Border_has_no_neighbour) {
  const NearestSurface surface(NormalMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, 1});
  for (std::size_t side = 0; side < 3; ++side) EXPECT_EQ(surface.neighbour(0, side), kNoTriangle);
}

TEST(NearestOnTriangle, Degenerate_triangles_are_segments_and_points) {
  const Vec3d p{0.25, 1, 0}, a{0, 0, 0}, b{1, 0, 0};
  for (const auto& [u, v, w] : {std::array{a, b, a}, {a, a, b}, {b, a, a}, {a, b, b}}) {
    EXPECT_NEAR(norm(p - nearest_on_triangle(p, u, v, w)), 1, 1e-15);
  }
  EXPECT_EQ(nearest_on_triangle(p, b, b, b), b);
  EXPECT_NEAR(norm(p - nearest_on_triangle(p, a, {0.5, 0, 0}, b)), 1, 1e-15);
}

TEST(NearestOnTriangle, Own_corners_are_at_distance_zero) {
  const std::vector<Vec3d> points = random_points(300, 3);
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(nearest_on_triangle(points[i + k], points[i], points[i + 1], points[i + 2]),
                points[i + k]);
    }
  }
}

}  // namespace
}  // namespace palpate::bake
