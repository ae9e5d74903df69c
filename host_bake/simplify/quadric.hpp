// SPDX-License-Identifier: GPL-3.0-or-later
// Quadric error metric (Garland and Heckbert 1997).
#pragma once

#include <array>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// Weighted sum of squared distances from planes, as a function of the point:
/// x . A x + 2 b . x (+ a constant that no decision needs).
struct Quadric {
  std::array<double, 6> a{};  ///< xx, xy, xz, yy, yz, zz
  Vec3d b{};

  Quadric& operator+=(const Quadric& other);
};

/// Of the plane through `point` with unit `normal`.
Quadric plane_quadric(Vec3d normal, Vec3d point, double weight);

/// The point of least error; where the planes leave it free, the one nearest to `middle`. False
/// where there are no planes.
bool least_error_point(const Quadric& quadric, Vec3d middle, Vec3d& out_point);

}  // namespace palpate::bake
