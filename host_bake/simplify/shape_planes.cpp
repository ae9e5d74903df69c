// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/shape_planes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "host_bake/decompose/geometry.hpp"
#include "host_bake/hull/predicates.hpp"

namespace palpate::bake {
namespace {

double largest(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// (b - a) x (c - a) . (p - a) with |p - a| <= 2.01 is off by less than 100 roundings of its largest
// term.
constexpr double kRoundings = 256 * 2.01 * std::numeric_limits<double>::epsilon();

}  // namespace

ShapePlanes::Plane ShapePlanes::plane_of(const PatchShape& shape, std::uint32_t face) const {
  const Triangle& t = shape.corners[face];
  const Vec3d a = points_[t[0]], ab = points_[t[1]] - a, ac = points_[t[2]] - a;
  return {cross(ab, ac), a, kRoundings * largest(ab) * largest(ac)};
}

void ShapePlanes::set(const PatchShape& shape) {
  points_.clear();
  for (const PointF& p : shape.points) points_.push_back(position(p));
  planes_.clear();
  for (std::uint32_t f = 0; f < shape.faces.size(); ++f) planes_.push_back(plane_of(shape, f));
}

void ShapePlanes::move(std::uint32_t point, const PointF& to) { points_[point] = position(to); }

bool ShapePlanes::above(const PatchShape& shape, const Plane& plane, std::uint32_t face,
                        std::uint32_t point, Vec3d at) {
  if (dot(plane.normal, at - plane.origin) < -plane.certain) return false;
  const Triangle& t = shape.corners[face];
  if (point == t[0] || point == t[1] || point == t[2]) return false;
  const std::vector<PointF>& p = shape.points;
  return orient_3d(p[t[0]], p[t[1]], p[t[2]], p[point]) > 0;
}

bool ShapePlanes::above(const PatchShape& shape, std::uint32_t face, std::uint32_t point) const {
  return above(shape, planes_[face], face, point, points_[point]);
}

bool ShapePlanes::any_above(const PatchShape& shape, std::uint32_t face, std::uint32_t first,
                            std::uint32_t last) const {
  const Plane plane = plane_of(shape, face);
  for (std::uint32_t p = first; p < last; ++p)
    if (above(shape, plane, face, p, points_[p])) return true;
  return false;
}

}  // namespace palpate::bake
