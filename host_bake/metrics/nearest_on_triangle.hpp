// SPDX-License-Identifier: GPL-3.0-or-later
// The point of a triangle nearest to a given one.
#pragma once

#include <algorithm>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// The part of a in a + b, both at least 0 (0 where both are).
inline double share_of(double a, double b) { return a > 0 ? a / (a + b) : 0; }

/// Nearest point to p of the segment from a to b.
inline Vec3d nearest_on_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d ab = b - a;
  const double from_a = std::max(dot(p - a, ab), 0.0), from_b = std::max(dot(b - p, ab), 0.0);
  return a + share_of(from_a, from_b) * ab;
}

/// Nearest point to p of a triangle that is no more than its longest side.
inline Vec3d nearest_on_longest_side(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const double ab = squared_norm(b - a), bc = squared_norm(c - b), ca = squared_norm(a - c);
  if (ab >= bc && ab >= ca) return nearest_on_segment(p, a, b);
  return bc >= ca ? nearest_on_segment(p, b, c) : nearest_on_segment(p, c, a);
}

/// Nearest point to p of the triangle (a, b, c), which may be degenerate. Rounding (of thin
/// triangles first of all) may give a point that is not the nearest, but always one of the
/// triangle, up to a few roundings of the coordinates: distances to it are never too small.
/// Source: Ericson, Real-Time Collision Detection, 2005, Sec. 5.1.5; the weights are kept in [0, 1]
/// here.
inline Vec3d nearest_on_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc < 0 && d1 >= 0 && d3 <= 0) return a + share_of(d1, -d3) * ab;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb < 0 && d2 >= 0 && d6 <= 0) return a + share_of(d2, -d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va < 0 && d4 >= d3 && d5 >= d6) return b + share_of(d4 - d3, d5 - d6) * (c - b);
  const double at_a = std::max(va, 0.0), at_b = std::max(vb, 0.0), at_c = std::max(vc, 0.0);
  const double total = at_a + at_b + at_c;
  if (!(total > 0)) return nearest_on_longest_side(p, a, b, c);
  const double scale = 1 / total;
  return a + (at_b * scale) * ab + (at_c * scale) * ac;
}

}  // namespace palpate::bake
