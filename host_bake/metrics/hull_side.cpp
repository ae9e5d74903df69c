// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/hull_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_bake/metrics/exact.hpp"
#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

double largest(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// (b - a) x (c - a) . (p - a) in double, |p - a| <= 2.51: off by less than 100 roundings of its
// largest term.
constexpr double kPlaneRoundings = 256 * 2.51 * std::numeric_limits<double>::epsilon();

Vec3d closest_on_segment(Vec3d p, Vec3d a, Vec3d b) {
  const double length_squared = squared_norm(b - a);
  if (length_squared == 0) return a;
  return a + std::clamp(dot(p - a, b - a) / length_squared, 0.0, 1.0) * (b - a);
}

// Closest point of a triangle; source: Ericson, Real-Time Collision Detection, 2005, Sec. 5.1.5.
Vec3d closest_on_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  const double scale = 1 / (va + vb + vc);
  return a + (vb * scale) * ab + (vc * scale) * ac;
}

}  // namespace

HullSide::HullSide(std::span<const PointF> points,
                   std::span<const std::array<std::uint32_t, 3>> faces, int dimension)
    : points_(points), faces_(faces), dimension_(dimension) {
  if (dimension_ < 3) return;
  planes_.reserve(faces.size());
  for (const auto& f : faces) {
    const Vec3d a = vec(points[f[0]]), ab = vec(points[f[1]]) - a, ac = vec(points[f[2]]) - a;
    planes_.push_back({cross(ab, ac), a, kPlaneRoundings * largest(ab) * largest(ac)});
  }
}

bool HullSide::below_all_planes(const PointF& p) const {
  const Vec3d at = vec(p);
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Plane& plane = planes_[i];
    if (dot(plane.normal, at - plane.origin) < -plane.certain) continue;
    const auto& f = faces_[i];
    if (side_of_plane(points_[f[0]], points_[f[1]], points_[f[2]], p) > 0) return false;
  }
  return true;
}

bool HullSide::contains(const PointF& p) const {
  if (dimension_ == 3) return below_all_planes(p);
  if (std::find(points_.begin(), points_.end(), p) != points_.end()) return true;
  // All other points become extreme points of the hull with them, unless they are inside.
  std::vector<PointF> with(points_.begin(), points_.end());
  with.push_back(p);
  return convex_hull(with).vertices.back() < points_.size();
}

double HullSide::distance(const PointF& p) const {
  if (contains(p)) return 0;
  const Vec3d at = vec(p);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& f : faces_) {
    const Vec3d closest =
        closest_on_triangle(at, vec(points_[f[0]]), vec(points_[f[1]]), vec(points_[f[2]]));
    least = std::min(least, norm(at - closest));
  }
  if (dimension_ < 2) {
    least = norm(at - closest_on_segment(at, vec(points_.front()), vec(points_.back())));
  }
  return least;
}

}  // namespace palpate::bake
