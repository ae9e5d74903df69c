// SPDX-License-Identifier: GPL-3.0-or-later
// The baker's points as vectors of doubles.
#pragma once

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

inline Vec3d vec(const Point& p) { return {p[0], p[1], p[2]}; }
inline Vec3d vec(const std::array<float, 3>& p) {
  return vec_cast<double>(Vec3f{p[0], p[1], p[2]});
}

/// Zero where v is.
inline Vec3d unit(Vec3d v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3d{};
}

}  // namespace palpate::bake
