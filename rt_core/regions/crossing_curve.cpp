// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crossing_curve.hpp"

#include "rt_core/regions/region_triangle.hpp"

namespace palpate::regions {
namespace {

using image::RegionTriangle;

struct Triangle {
  Vec3d corners[3];
  Vec3d normal{};  // as long as twice the area
};

/// Where a triangle meets the plane of another.
struct Cut {
  Vec3d begin{};
  Vec3d end{};
  bool found = false;
};

/// What the cuts of two triangles, which lie on one line, have in common.
struct Segment {
  Vec3d begin{};
  Vec3d end{};
  double length = 0;  // 0: nothing
};

Triangle triangle(Vec3d p, Vec3d q, Vec3d r) noexcept { return {{p, q, r}, cross(q - p, r - p)}; }

/// A corner in the plane counts as above it, so that two edges pass through it or none.
Cut cut(const Triangle& t, const Triangle& plane, Vec3d along) noexcept {
  double above[3];
  for (int i = 0; i < 3; ++i) above[i] = dot(plane.normal, t.corners[i] - plane.corners[0]);
  Vec3d ends[2];
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = i < 2 ? i + 1 : 0;
    if ((above[i] < 0) == (above[j] < 0)) continue;
    const double share = above[i] / (above[i] - above[j]);
    ends[count++] = t.corners[i] + share * (t.corners[j] - t.corners[i]);
  }
  if (count != 2) return {};
  const bool forward = dot(along, ends[1] - ends[0]) >= 0;
  return {ends[forward ? 0 : 1], ends[forward ? 1 : 0], true};
}

Segment common(const Triangle& a, const Triangle& b) noexcept {
  const Vec3d both = cross(a.normal, b.normal);
  const double size = norm(both);
  if (!(size > 0)) return {};
  const Vec3d along = (1 / size) * both;
  const Cut of_a = cut(a, b, along);
  const Cut of_b = cut(b, a, along);
  if (!of_a.found || !of_b.found) return {};
  const bool a_later = dot(along, of_a.begin - of_b.begin) > 0;
  const bool a_sooner = dot(along, of_b.end - of_a.end) > 0;
  Segment out{a_later ? of_a.begin : of_b.begin, a_sooner ? of_a.end : of_b.end};
  const double length = dot(along, out.end - out.begin);
  if (!(length > 0)) return {};
  out.length = length;
  return out;
}

}  // namespace

void add_segment(const levels::PairState& pair, std::uint32_t triangle_a, std::uint32_t triangle_b,
                 CrossingCurve& curve) noexcept {
  const RegionTriangle& of_a = pair.image_a->region_triangles[triangle_a];
  const RegionTriangle& of_b = pair.image_b->region_triangles[triangle_b];
  // Relative to a corner, only the size of the pair is rounded.
  const Vec3d origin = corner(of_a, 0, pair.scale_a);
  const Vec3d from_origin = pair.b_in_a.translation - origin;
  const Mat3d& r = pair.b_in_a.rotation;
  const Triangle a =
      triangle({}, corner(of_a, 1, pair.scale_a) - origin, corner(of_a, 2, pair.scale_a) - origin);
  const Triangle b = triangle(r * corner(of_b, 0, pair.scale_b) + from_origin,
                              r * corner(of_b, 1, pair.scale_b) + from_origin,
                              r * corner(of_b, 2, pair.scale_b) + from_origin);
  const Segment s = common(a, b);
  if (!(s.length > 0)) return;
  curve.length += s.length;
  curve.moment += s.length * (origin + 0.5 * (s.begin + s.end));
  if (is_closed(*pair.image_a, of_a)) curve.along_a -= (s.length / norm(a.normal)) * a.normal;
  if (is_closed(*pair.image_b, of_b)) curve.along_b += (s.length / norm(b.normal)) * b.normal;
}

}  // namespace palpate::regions
