// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/quadric.hpp"

#include <cstddef>

namespace palpate::bake {
namespace {

// Pull to the middle, relative to the planes' weight: far below what a dihedral angle of half a
// degree weighs (1e-5), far above rounding.
constexpr double kPull = 1e-7;

}  // namespace

Quadric& Quadric::operator+=(const Quadric& other) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += other.a[i];
  b += other.b;
  return *this;
}

Quadric plane_quadric(Vec3d n, Vec3d point, double weight) {
  const double d = -dot(n, point);
  return {{weight * n.x * n.x, weight * n.x * n.y, weight * n.x * n.z, weight * n.y * n.y,
           weight * n.y * n.z, weight * n.z * n.z},
          (weight * d) * n};
}

bool least_error_point(const Quadric& q, Vec3d middle, Vec3d& out_point) {
  const double trace = q.a[0] + q.a[3] + q.a[5];
  if (!(trace > 0)) return false;
  const double pull = kPull * trace;
  const double xx = q.a[0] + pull, yy = q.a[3] + pull, zz = q.a[5] + pull;
  const double xy = q.a[1], xz = q.a[2], yz = q.a[4];
  // Relative to the middle: A d = -(A middle + b), by the inverse of the symmetric matrix.
  const Vec3d g = {q.a[0] * middle.x + xy * middle.y + xz * middle.z + q.b.x,
                   xy * middle.x + q.a[3] * middle.y + yz * middle.z + q.b.y,
                   xz * middle.x + yz * middle.y + q.a[5] * middle.z + q.b.z};
  const Vec3d c0 = {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy};
  const Vec3d c1 = {c0.y, xx * zz - xz * xz, xy * xz - xx * yz};
  const Vec3d c2 = {c0.z, c1.z, xx * yy - xy * xy};
  const double determinant = xx * c0.x + xy * c0.y + xz * c0.z;
  if (!(determinant > 0)) return false;
  out_point = middle - (1 / determinant) * Vec3d{dot(c0, g), dot(c1, g), dot(c2, g)};
  return true;
}

}  // namespace palpate::bake
