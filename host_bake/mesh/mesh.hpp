// SPDX-License-Identifier: GPL-3.0-or-later
// The baker's meshes: indexed triangles, nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace palpate::bake {

using Point = std::array<double, 3>;
using Face = std::array<std::uint32_t, 3>;  ///< vertex indices, counter-clockwise seen from outside

struct Mesh {
  std::vector<Point> points;  ///< metres (after the unit scale)
  std::vector<Face> faces;
};

/// A mesh with its vertices relative to the object's centre, divided by its radius and rounded to
/// float: what is baked is convex, disjoint or coplanar in exactly these numbers. The rounding
/// moves a vertex by at most 6e-8 of the radius.
struct NormalMesh {
  std::vector<std::array<float, 3>> points;  ///< inside the unit ball (up to rounding)
  std::vector<Face> faces;
  Point centre_m{};     ///< of the smallest enclosing sphere of the vertices
  double radius_m = 0;  ///< its radius
};

/// Centre, radius and rounding as above. Throws InputRefused where the mesh is empty or its radius
/// zero or not finite. Unreferenced vertices do not count. O(n) expected.
NormalMesh normalise(const Mesh& mesh);

/// The radius of that sphere in metres; 0 where there is none to measure. Precondition: finite
/// coordinates, indices in range. O(n) expected.
double radius_of(const Mesh& mesh);

}  // namespace palpate::bake
