// SPDX-License-Identifier: GPL-3.0-or-later
// Distances of meshes by trying every pair of triangles, with CGAL's distance in double: an oracle
// that shares no code with the engine.
#pragma once

#include <CGAL/Simple_cartesian.h>
#include <CGAL/squared_distance_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "tests/support/baked_scene.hpp"

namespace palpate::test {

using Kernel = CGAL::Simple_cartesian<double>;

struct PlacedTriangles {
  PlacedTriangles(const bake::Mesh& mesh, const Pose& pose) {
    for (const bake::Face& f : mesh.faces) {
      std::array<Kernel::Point_3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d x = place(pose, mesh.points[f[k]]);
        p[k] = {x.x, x.y, x.z};
      }
      const auto middle = CGAL::centroid(p[0], p[1], p[2]);
      double radius2 = 0;
      for (const auto& x : p) radius2 = std::max(radius2, CGAL::squared_distance(middle, x));
      triangles.emplace_back(p[0], p[1], p[2]);
      centres.push_back(middle);
      radii.push_back(std::sqrt(radius2));
    }
  }
  std::vector<Kernel::Triangle_3> triangles;
  std::vector<Kernel::Point_3> centres;
  std::vector<double> radii;
};

/// Distance of triangle i of a from the whole of b, or `most` where that is less.
inline double distance_from(const PlacedTriangles& a, std::size_t i, const PlacedTriangles& b,
                            double most) {
  for (std::size_t j = 0; j < b.triangles.size(); ++j) {
    const double spheres =
        std::sqrt(CGAL::squared_distance(a.centres[i], b.centres[j])) - a.radii[i] - b.radii[j];
    if (spheres < most)
      most = std::min(most, std::sqrt(CGAL::squared_distance(a.triangles[i], b.triangles[j])));
  }
  return most;
}

inline double distance_of(const PlacedTriangles& a, const PlacedTriangles& b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.triangles.size(); ++i) least = distance_from(a, i, b, least);
  return least;
}

/// Groups of triangles of a that are nearer to b than `reach` and joined by shared vertices.
inline std::vector<std::vector<std::size_t>> near_regions(const bake::Mesh& mesh,
                                                          const PlacedTriangles& a,
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
