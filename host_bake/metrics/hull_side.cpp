// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/hull_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_bake/metrics/exact.hpp"
#include "host_bake/metrics/nearest_on_triangle.hpp"
#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

double largest(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// (b - a) x (c - a) . (p - a) in double, |p - a| <= 2.51: off by less than 100 roundings of its
// largest term.
constexpr double kPlaneRoundings = 256 * 2.51 * std::numeric_limits<double>::epsilon();

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
        nearest_on_triangle(at, vec(points_[f[0]]), vec(points_[f[1]]), vec(points_[f[2]]));
    least = std::min(least, norm(at - closest));
  }
  if (dimension_ < 2) {
    least = norm(at - nearest_on_segment(at, vec(points_.front()), vec(points_.back())));
  }
  return least;
}

}  // namespace palpate::bake
