// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh's corners and faces as vectors of doubles.
#pragma once

#include <cmath>
#include <cstdint>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

inline Vec3d position(const std::array<float, 3>& p) {
  return vec_cast<double>(Vec3f{p[0], p[1], p[2]});
}
inline Vec3d position(const NormalMesh& mesh, std::uint32_t vertex) {
  return position(mesh.points[vertex]);
}

/// Along the face's normal, twice its area long.
inline Vec3d area_vector(const NormalMesh& mesh, const Face& face) {
  const Vec3d a = position(mesh, face[0]);
  return cross(position(mesh, face[1]) - a, position(mesh, face[2]) - a);
}

/// A unit vector perpendicular to a unit vector.
inline Vec3d any_perpendicular(Vec3d n) {
  const double x = std::abs(n.x);
  const double y = std::abs(n.y);
  const double z = std::abs(n.z);
  const Vec3d least = x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  const Vec3d p = cross(n, least);
  return (1 / norm(p)) * p;
}

}  // namespace palpate::bake
