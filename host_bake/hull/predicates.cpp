// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hull/predicates.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cmath>
#include <cstddef>

namespace palpate::bake {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Relative error bounds of the determinants below, differences included: (7 + 56 e) e and
// (3 + 16 e) e with e = 2^-53, rounded up. Products of three float differences cannot underflow.
constexpr double kFilter3d = 7.78e-16;
constexpr double kFilter2d = 3.34e-16;

struct Difference {
  double x, y, z;
};

Difference difference(const PointF& a, const PointF& b) {
  return {static_cast<double>(a[0]) - static_cast<double>(b[0]),
          static_cast<double>(a[1]) - static_cast<double>(b[1]),
          static_cast<double>(a[2]) - static_cast<double>(b[2])};
}

Kernel::Point_3 exact_point(const PointF& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

}  // namespace

int orient_3d(const PointF& a, const PointF& b, const PointF& c, const PointF& d) {
  const Difference u = difference(b, a);
  const Difference v = difference(c, a);
  const Difference w = difference(d, a);
  const double uy_vz = u.y * v.z;
  const double uz_vy = u.z * v.y;
  const double uz_vx = u.z * v.x;
  const double ux_vz = u.x * v.z;
  const double ux_vy = u.x * v.y;
  const double uy_vx = u.y * v.x;
  const double determinant = (uy_vz - uz_vy) * w.x + (uz_vx - ux_vz) * w.y + (ux_vy - uy_vx) * w.z;
  const double permanent = (std::abs(uy_vz) + std::abs(uz_vy)) * std::abs(w.x) +
                           (std::abs(uz_vx) + std::abs(ux_vz)) * std::abs(w.y) +
                           (std::abs(ux_vy) + std::abs(uy_vx)) * std::abs(w.z);
  const double bound = kFilter3d * permanent;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  if (permanent == 0) return 0;  // every product vanished, and none of them can underflow
  return CGAL::orientation(exact_point(a), exact_point(b), exact_point(c), exact_point(d));
}

int orient_2d(const PointF& a, const PointF& b, const PointF& c, Axis dropped) {
  const auto i = static_cast<std::size_t>((dropped + 1) % 3);
  const auto j = static_cast<std::size_t>((dropped + 2) % 3);
  const auto at = [](const PointF& p, std::size_t k) { return static_cast<double>(p[k]); };
  const double left = (at(b, i) - at(a, i)) * (at(c, j) - at(a, j));
  const double right = (at(b, j) - at(a, j)) * (at(c, i) - at(a, i));
  const double determinant = left - right;
  const double bound = kFilter2d * (std::abs(left) + std::abs(right));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  if (left == 0 && right == 0) return 0;
  using Point = Kernel::Point_2;
  return CGAL::orientation(Point(at(a, i), at(a, j)), Point(at(b, i), at(b, j)),
                           Point(at(c, i), at(c, j)));
}

bool collinear(const PointF& a, const PointF& b, const PointF& c) {
  return orient_2d(a, b, c, 0) == 0 && orient_2d(a, b, c, 1) == 0 && orient_2d(a, b, c, 2) == 0;
}

Projection projection_of(const PointF& a, const PointF& b, const PointF& c) {
  const Difference u = difference(b, a);
  const Difference v = difference(c, a);
  const double area[3] = {std::abs(u.y * v.z - u.z * v.y), std::abs(u.z * v.x - u.x * v.z),
                          std::abs(u.x * v.y - u.y * v.x)};
  Axis best = area[1] > area[0] ? 1 : 0;
  if (area[2] > area[best]) best = 2;
  // The largest area is right but for slivers, where rounding may hide which one is not zero.
  for (Axis k = 0; k < 3; ++k) {
    const Axis dropped = (best + k) % 3;
    const int facing = orient_2d(a, b, c, dropped);
    if (facing != 0) return {dropped, facing};
  }
  return {};
}

}  // namespace palpate::bake
