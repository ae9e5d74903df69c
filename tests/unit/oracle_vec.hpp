// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of the oracles, apart from those of the code that they judge.
#pragma once

#include <algorithm>
#include <cmath>

#include "host_bake/hull/hull.hpp"

namespace palpate::test {

struct Vec {
  long double x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(long double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
inline long double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline long double length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec vec(const bake::PointF& p) {
  return {static_cast<long double>(p[0]), static_cast<long double>(p[1]),
          static_cast<long double>(p[2])};
}

/// Distance of a point from a triangle: from its plane where the foot is inside, else from its
/// sides.
inline long double distance(Vec p, Vec a, Vec b, Vec c) {
  const auto from_side = [&](Vec s, Vec e) {
    const Vec d = e - s;
    const long double l = dot(d, d);
    const long double t = l > 0 ? std::clamp(dot(p - s, d) / l, 0.0L, 1.0L) : 0.0L;
    return length(p - (s + t * d));
  };
  const Vec n = cross(b - a, c - a);
  const bool inside = dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                      dot(cross(a - c, p - c), n) >= 0 && dot(n, n) > 0;
  if (inside) return std::abs(dot(n, p - a)) / length(n);
  return std::min({from_side(a, b), from_side(b, c), from_side(c, a)});
}

struct Plane {
  Vec normal;
  long double offset;
};

inline Plane plane_of(Vec a, Vec b, Vec c) {
  const Vec n = cross(b - a, c - a);
  const Vec unit = (1 / length(n)) * n;
  return {unit, dot(unit, a)};
}

}  // namespace palpate::test
