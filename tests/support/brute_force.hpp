// SPDX-License-Identifier: GPL-3.0-or-later
// Distances of meshes by trying every pair of triangles, with CGAL's distance in double: an oracle
// that shares no code with the engine.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "tests/support/baked_scene.hpp"

namespace palpate::test {

/// The triangles of a mesh where a pose puts them, in the order of its faces.
struct PlacedTriangles {
  PlacedTriangles(const bake::Mesh& mesh, const Pose& pose);
  std::vector<std::array<Vec3d, 3>> corners;
  std::vector<Vec3d> centres;
  std::vector<double> radii;  ///< about the centres
};

/// Distance of triangle i of a from triangle j of b.
double distance_between(const PlacedTriangles& a, std::size_t i, const PlacedTriangles& b,
                        std::size_t j);

/// Distance of triangle i of a from the whole of b, or `most` where that is less.
double distance_from(const PlacedTriangles& a, std::size_t i, const PlacedTriangles& b,
                     double most);

double distance_of(const PlacedTriangles& a, const PlacedTriangles& b);

/// Distances of a, moved, from b, not moved, at ticks 0 to `ticks` - 1 of a motion.
std::vector<double> distances_along(const bake::Mesh& a, const bake::Mesh& b, Pose (&motion)(int),
                                    int ticks);

/// Distance of a point from the nearest of some triangles.
double distance_to(const PlacedTriangles& a, std::span<const std::size_t> triangles, Vec3d point);

/// Groups of triangles of a that are nearer to b than `reach` and joined by shared vertices.
std::vector<std::vector<std::size_t>> near_regions(const bake::Mesh& mesh, const PlacedTriangles& a,
                                                   const PlacedTriangles& b, double reach);

}  // namespace palpate::test
