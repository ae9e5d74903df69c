// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/brute_force.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/squared_distance_3.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::test {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Kernel::Point_3 to_cgal(Vec3d p) { return {p.x, p.y, p.z}; }

Kernel::Triangle_3 triangle(const PlacedTriangles& t, std::size_t i) {
  return {to_cgal(t.corners[i][0]), to_cgal(t.corners[i][1]), to_cgal(t.corners[i][2])};
}

}  // namespace

PlacedTriangles::PlacedTriangles(const bake::Mesh& mesh, const Pose& pose) {
  for (const bake::Face& f : mesh.faces) {
    const std::array<Vec3d, 3> c{place(pose, mesh.points[f[0]]), place(pose, mesh.points[f[1]]),
                                 place(pose, mesh.points[f[2]])};
    const Vec3d centre = (1.0 / 3) * (c[0] + c[1] + c[2]);
    double radius = 0;
    for (const Vec3d& x : c) radius = std::max(radius, norm(x - centre));
    corners.push_back(c);
    centres.push_back(centre);
    radii.push_back(radius);
  }
}

double distance_between(const PlacedTriangles& a, std::size_t i, const PlacedTriangles& b,
                        std::size_t j) {
  return std::sqrt(CGAL::squared_distance(triangle(a, i), triangle(b, j)));
}

double distance_from(const PlacedTriangles& a, std::size_t i, const PlacedTriangles& b,
                     double most) {
  for (std::size_t j = 0; j < b.corners.size(); ++j) {
    const double spheres = norm(a.centres[i] - b.centres[j]) - a.radii[i] - b.radii[j];
    if (spheres < most) most = std::min(most, distance_between(a, i, b, j));
  }
  return most;
}

double distance_of(const PlacedTriangles& a, const PlacedTriangles& b) {
  double least = kInfinity;
  for (std::size_t i = 0; i < a.corners.size(); ++i) least = distance_from(a, i, b, least);
  return least;
}

std::vector<double> distances_along(const bake::Mesh& a, const bake::Mesh& b, Pose (&motion)(int),
                                    int ticks) {
  const PlacedTriangles fixed(b, {});
  std::vector<double> out;
  for (int i = 0; i < ticks; ++i) out.push_back(distance_of(PlacedTriangles(a, motion(i)), fixed));
  return out;
}

double distance_to(const PlacedTriangles& a, std::span<const std::size_t> triangles, Vec3d point) {
  double least2 = kInfinity;
  for (const std::size_t t : triangles)
    least2 = std::min(least2, CGAL::squared_distance(triangle(a, t), to_cgal(point)));
  return std::sqrt(least2);
}

std::vector<std::vector<std::size_t>> near_regions(const bake::Mesh& mesh, const PlacedTriangles& a,
                                                   const PlacedTriangles& b, double reach) {
  std::vector<char> near(mesh.faces.size());
  for (std::size_t i = 0; i < near.size(); ++i) near[i] = distance_from(a, i, b, reach) < reach;
  std::vector<std::vector<std::size_t>> of_vertex(mesh.points.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (near[i]) {
      for (const std::uint32_t v : mesh.faces[i]) of_vertex[v].push_back(i);
    }
  }
  std::vector<std::vector<std::size_t>> regions;
  for (std::size_t seed = 0; seed < near.size(); ++seed) {
    if (!near[seed]) continue;
    std::vector<std::size_t> region{seed};
    near[seed] = 0;
    for (std::size_t k = 0; k < region.size(); ++k) {
      for (const std::uint32_t v : mesh.faces[region[k]]) {
        for (const std::size_t other : of_vertex[v]) {
          if (near[other]) region.push_back(other), near[other] = 0;
        }
      }
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace palpate::test
