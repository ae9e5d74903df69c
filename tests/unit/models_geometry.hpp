// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of the procedural models measure, independently of the code under test.
#pragma once

#include <cstddef>
#include <cstdint>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::test {

/// Combinatorics of a mesh and its volume.
struct Topology {
  bool closed_manifold = false;  ///< every edge once in each direction, one fan around each vertex
  std::size_t components = 0;
  std::int64_t euler = 0;  ///< V - E + F
  double volume_m3 = 0;    ///< positive where faces look outward
};
Topology topology(const bake::Mesh& mesh);

/// Pairs of faces that meet in more than a shared vertex or edge (CGAL, exact predicates).
std::size_t self_crossings(const bake::Mesh& mesh);

/// Edges that are not strictly convex (exact predicate).
std::size_t edges_not_convex(const bake::Mesh& mesh);

/// Radius of the smallest enclosing sphere, within 1 %.
double radius_m(const bake::Mesh& mesh);

/// Two meshes against each other.
struct Clearance {
  std::size_t crossings = 0;  ///< faces of one that meet the other
  double least_m = 0;         ///< from vertices and middles of edges of each to the other
};
Clearance clearance(const bake::Mesh& a, const bake::Mesh& b);

/// FNV-1a over coordinates (in units of 2^-35 m) and indices.
std::uint64_t fingerprint(const bake::Mesh& mesh);

}  // namespace palpate::test
