// SPDX-License-Identifier: Apache-2.0
// How much lies in nearly one direction: a smooth kernel over the sphere.
#pragma once

#include "rt_core/geometry/vec3.hpp"

namespace palpate {

/// How far two unit normals count as one, by the cosine c between them: c^2 (1 + c) / 2. One for
/// equal normals, zero for perpendicular and for opposed ones, nowhere negative; the polynomial of
/// least degree that is so. Its mean over the sphere is 1/6: normals from all around count as the
/// six faces of a box. Real is double, or several at once.
template <class Real>
constexpr Real kinship(Real cosine) noexcept {
  return 0.5 * cosine * cosine * (1.0 + cosine);
}

/// Sum of masses times their kinship with any direction, from moments of second and third order: no
/// pairs of masses are visited. Independent of the order of adding but for rounding.
class Directions {
 public:
  /// @param n  unit
  constexpr void add(Vec3d n, double mass) noexcept {
    const Vec3d u = mass * n;
    const double xx = u.x * n.x, yy = u.y * n.y, zz = u.z * n.z, xy = u.x * n.y;
    squares_ += {xx, yy, zz};
    products_ += {xy, u.y * n.z, u.z * n.x};
    cubes_ += {xx * n.x, yy * n.y, zz * n.z};
    next_ += {xx * n.y, yy * n.z, zz * n.x};
    last_ += {xx * n.z, yy * n.x, zz * n.y};
    all_ += xy * n.z;
  }

  /// Sum over all masses m_j of m_j kinship(n . n_j); off by rounding of the whole sum.
  [[nodiscard]] constexpr double around(Vec3d n) const noexcept {
    const Vec3d square{n.x * n.x, n.y * n.y, n.z * n.z};
    const Vec3d product{n.x * n.y, n.y * n.z, n.z * n.x};
    const double second = dot(squares_, square) + 2 * dot(products_, product);
    const Vec3d cube{square.x * n.x, square.y * n.y, square.z * n.z};
    const Vec3d next{square.x * n.y, square.y * n.z, square.z * n.x};
    const Vec3d last{square.x * n.z, square.y * n.x, square.z * n.y};
    const double third =
        dot(cubes_, cube) + 3 * (dot(next_, next) + dot(last_, last)) + 6 * all_ * product.x * n.z;
    return 0.5 * (second + third);
  }

 private:
  Vec3d squares_{};   // xx yy zz
  Vec3d products_{};  // xy yz zx
  Vec3d cubes_{};     // xxx yyy zzz
  Vec3d next_{};      // xxy yyz zzx
  Vec3d last_{};      // xxz yyx zzy
  double all_ = 0;    // xyz
};

}  // namespace palpate
