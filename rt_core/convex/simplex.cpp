// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/simplex.hpp"

#include "rt_core/base/assert.hpp"

namespace palpate::convex {
namespace {

Nearest nearest_on_point(const Vec3d* points, std::uint32_t i) noexcept {
  Nearest n;
  n.axis = points[i];
  n.squared = squared_norm(points[i]);
  n.count = 1;
  n.index[0] = i;
  n.weight[0] = 1;
  return n;
}

void keep_nearer(Nearest& best, const Nearest& candidate) noexcept {
  if (best.count == 0 || candidate.squared < best.squared) best = candidate;
}

/// area_normal(), in registers: a call would pass the points through memory.
[[gnu::always_inline]] inline Vec3d normal_of(const Vec3d& p0, const Vec3d& p1, const Vec3d& p2,
                                              double& out_scale) noexcept {
  const Vec3d e01 = p1 - p0;
  const Vec3d e12 = p2 - p1;
  const Vec3d e20 = p0 - p2;
  const double l01 = squared_norm(e01);
  const double l12 = squared_norm(e12);
  const double l20 = squared_norm(e20);
  if (l01 >= l12 && l01 >= l20) {
    out_scale = l12 * l20;
    return cross(e12, e20);
  }
  if (l12 >= l20) {
    out_scale = l20 * l01;
    return cross(e20, e01);
  }
  out_scale = l01 * l12;
  return cross(e01, e12);
}

/// Where the origin lies, seen from the plane through i, j, k.
struct Side {
  double height = 0;  ///< six times the signed volume with the origin; > 0 on the side of -normal
  double error = 0;   ///< of height
};

Side side_of_origin(const Vec3d* p, std::uint32_t i, std::uint32_t j, std::uint32_t k) noexcept {
  constexpr double kRoundings = 1e-15;
  const Vec3d u = p[j] - p[i];
  const Vec3d v = p[k] - p[i];
  const double size2 = squared_norm(u) * squared_norm(v) * squared_norm(p[i]);
  return {dot(p[i], cross(u, v)), kRoundings * sqrt_of(size2)};
}

Nearest enclosed() noexcept {
  Nearest n;
  n.count = 4;
  return n;
}

Nearest nearest_on_tetrahedron(const Vec3d* p, Carry carry) noexcept {
  constexpr double kMinVolume2 = 1e-28;  // rounding of the determinant is 1e-15 of the edge product
  const Vec3d u = p[0] - p[3];
  const Vec3d v = p[1] - p[3];
  const Vec3d w = p[2] - p[3];
  const double volume = dot(u, cross(v, w));  // > 0: face 0 1 2 is counter-clockwise from outside
  const double size2 = squared_norm(u) * squared_norm(v) * squared_norm(w);
  const bool flat = !(volume * volume > kMinVolume2 * size2);
  // The last point comes last in each face that has it.
  constexpr std::uint32_t kFaces[4][3] = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {2, 1, 3}};
  Nearest best;
  bool inside = !flat;
  for (const auto& f : kFaces) {
    const Side side = side_of_origin(p, f[0], f[1], f[2]);
    const double inward = volume > 0 ? side.height : -side.height;
    if (!flat && inward > side.error) continue;
    inside = false;
    if (carry == Carry::last && f[2] != 3) continue;
    keep_nearer(best, nearest_on_triangle(p, f[0], f[1], f[2], carry));
  }
  if (inside) return enclosed();
  for (std::uint32_t f = 1; f < 4 && best.count == 0; ++f) {
    best = nearest_on_triangle(p, kFaces[f][0], kFaces[f][1], kFaces[f][2], carry);
  }
  return best;
}

}  // namespace

Vec3d area_normal(const Vec3d& p0, const Vec3d& p1, const Vec3d& p2, double& out_scale) noexcept {
  return normal_of(p0, p1, p2, out_scale);
}

Nearest nearest_on_segment(const Vec3d* points, std::uint32_t i, std::uint32_t j) noexcept {
  const Vec3d edge = points[j] - points[i];
  const double length2 = squared_norm(edge);
  const double along = -dot(points[i], edge);
  if (!(along > 0)) return nearest_on_point(points, i);
  if (!(along < length2)) return nearest_on_point(points, j);
  const double s = along / length2;
  Nearest n;
  n.axis = points[i] + s * edge;
  // Where the origin is near, rounding of the large terms tilts the axis; square it to the edge.
  n.axis -= (dot(n.axis, edge) / length2) * edge;
  n.squared = squared_norm(n.axis);
  n.count = 2;
  n.index[0] = i;
  n.index[1] = j;
  n.weight[0] = 1 - s;
  n.weight[1] = s;
  return n;
}

Nearest nearest_on_triangle(const Vec3d* points, std::uint32_t i, std::uint32_t j, std::uint32_t k,
                            Carry carry) noexcept {
  const Vec3d& p0 = points[i];
  const Vec3d& p1 = points[j];
  const Vec3d& p2 = points[k];
  double scale = 0;
  const Vec3d normal = normal_of(p0, p1, p2, scale);
  const double normal2 = squared_norm(normal);
  // Barycentric coordinates of the origin's projection, times normal2.
  const double w0 = dot(normal, cross(p1, p2 - p1));
  const double w1 = dot(normal, cross(p2, p0 - p2));
  const double w2 = dot(normal, cross(p0, p1 - p0));
  const bool flat = !(normal2 > kMinSine * kMinSine * scale);
  if (!flat && w0 > 0 && w1 > 0 && w2 > 0) {
    const double height = dot(normal, p0);
    const double inverse = 1 / (w0 + w1 + w2);
    Nearest n;
    n.axis = height < 0 ? -normal : normal;
    n.squared = height * height / normal2;
    n.count = 3;
    n.index[0] = i;
    n.index[1] = j;
    n.index[2] = k;
    n.weight[0] = w0 * inverse;
    n.weight[1] = w1 * inverse;
    n.weight[2] = w2 * inverse;
    return n;
  }
  // Only edges that the projection lies beyond can be nearest.
  const bool last = carry == Carry::last;
  Nearest best;
  if (flat || last || !(w1 > 0)) keep_nearer(best, nearest_on_segment(points, i, k));
  if (flat || last || !(w0 > 0)) keep_nearer(best, nearest_on_segment(points, j, k));
  if (!last && (flat || !(w2 > 0))) keep_nearer(best, nearest_on_segment(points, i, j));
  return best;
}

Nearest nearest_on_simplex(const Vec3d* points, std::uint32_t count, Carry carry) noexcept {
  PALPATE_ASSERT(count >= 1 && count <= 4);
  switch (count) {
    case 1:
      return nearest_on_point(points, 0);
    case 2:
      return nearest_on_segment(points, 0, 1);
    case 3:
      return nearest_on_triangle(points, 0, 1, 2, carry);
    default:
      return nearest_on_tetrahedron(points, carry);
  }
}

}  // namespace palpate::convex
