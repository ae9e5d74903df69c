// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull_oracle.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "oracle_vec.hpp"

namespace palpate::test {
namespace {

using bake::HullMesh;
using bake::PointF;
using Exact = boost::multiprecision::int1024_t;
using Triple = std::array<std::uint32_t, 3>;

/// A float below 2^100 as a whole number of units of 2^-173.
Exact exact(float x) {
  int exponent = 0;
  const float mantissa = std::frexp(x, &exponent);
  const Exact whole(static_cast<std::int64_t>(std::ldexp(mantissa, 24)));
  return whole * (Exact(1) << static_cast<unsigned>(exponent - 24 + 173));
}

std::string judge_solid(std::span<const PointF> points, const HullMesh& hull) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Triple> edges;
  for (const Triple& f : hull.faces)
    for (std::size_t i = 0; i < 3; ++i)
      if (!edges.try_emplace({f[i], f[(i + 1) % 3]}, f).second) return "an edge occurs twice";
  if (hull.vertices.size() + hull.faces.size() != edges.size() / 2 + 2) return "no sphere";
  const auto point = [&](std::uint32_t v) { return points[hull.vertices[v]]; };
  for (const auto& [edge, face] : edges)
    if (!edges.contains({edge.second, edge.first})) return "an edge has one face";
  std::vector<std::vector<Triple>> planes_at(hull.vertices.size());
  for (const Triple& f : hull.faces) {
    if (in_line(point(f[0]), point(f[1]), point(f[2]))) return "a face without area";
    for (const PointF& p : points)
      if (exact_side(point(f[0]), point(f[1]), point(f[2]), p) > 0) return "a point is outside";
    for (const std::uint32_t v : f) {
      const bool known =
          std::any_of(planes_at[v].begin(), planes_at[v].end(), [&](const Triple& g) {
            return std::all_of(g.begin(), g.end(), [&](std::uint32_t w) {
              return exact_side(point(f[0]), point(f[1]), point(f[2]), point(w)) == 0;
            });
          });
      if (!known) planes_at[v].push_back(f);
    }
  }
  for (const auto& planes : planes_at)
    if (planes.size() < 3) return "a vertex is not extreme";
  return {};
}

std::string judge_flat(std::span<const PointF> points, const HullMesh& hull) {
  const std::size_t n = hull.vertices.size();
  if (n < 3 || hull.faces.size() != 2 * (n - 2)) return "not two sides of a polygon";
  const std::set<Triple> faces(hull.faces.begin(), hull.faces.end());
  const auto point = [&](std::uint32_t v) { return points[hull.vertices[v]]; };
  long double up = 0;
  long double total = 0;
  const Triple& base = hull.faces.front();
  const Plane plane = plane_of(vec(point(base[0])), vec(point(base[1])), vec(point(base[2])));
  for (const Triple& f : hull.faces) {
    if (!faces.contains({f[0], f[2], f[1]})) return "a face has no other side";
    for (const PointF& p : points)
      if (exact_side(point(f[0]), point(f[1]), point(f[2]), p) != 0) return "not flat";
    const Vec a = vec(point(f[0]));
    const Vec area = cross(vec(point(f[1])) - a, vec(point(f[2])) - a);
    total += length(area);
    up += dot(area, plane.normal);
  }
  if (std::abs(up) > 1e-12L * total) return "the sides differ";
  // A vertex is extreme where no triangle of three other vertices, or segment of two, holds it.
  for (std::uint32_t v = 0; v < n; ++v)
    for (std::uint32_t a = 0; a < n; ++a)
      for (std::uint32_t b = a + 1; b < n; ++b)
        if (v != a && v != b && in_line(point(a), point(v), point(b)) &&
            std::min(point(a), point(b)) < point(v) && point(v) < std::max(point(a), point(b)))
          return "a vertex is not extreme";
  for (const PointF& p : points) {
    const bool inside = std::any_of(hull.faces.begin(), hull.faces.end(), [&](const Triple& f) {
      return distance(vec(p), vec(point(f[0])), vec(point(f[1])), vec(point(f[2]))) < 1e-15L;
    });
    if (!inside) return "a point is outside";
  }
  return {};
}

}  // namespace

int exact_side(const PointF& a, const PointF& b, const PointF& c, const PointF& d) {
  const Vec n = cross(vec(b) - vec(a), vec(c) - vec(a));
  const long double rough = dot(n, vec(d) - vec(a));
  if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
  const Vec u = vec(b) - vec(a);
  const Vec v = vec(c) - vec(a);
  const long double scale = length(u) * length(v) * length(vec(d) - vec(a));
  if (std::abs(rough) > 1e-15L * scale) return rough > 0 ? 1 : -1;
  const auto difference = [](const PointF& p, const PointF& q, std::size_t i) {
    return exact(p[i]) - exact(q[i]);
  };
  Exact sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    sum += (difference(b, a, j) * difference(c, a, k) - difference(b, a, k) * difference(c, a, j)) *
           difference(d, a, i);
  }
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

bool in_line(const PointF& a, const PointF& b, const PointF& c) {
  const Vec u = vec(b) - vec(a);
  const Vec v = vec(c) - vec(a);
  if (length(cross(u, v)) > 1e-15L * length(u) * length(v)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Exact area = (exact(b[i]) - exact(a[i])) * (exact(c[j]) - exact(a[j])) -
                       (exact(b[j]) - exact(a[j])) * (exact(c[i]) - exact(a[i]));
    if (area != 0) return false;
  }
  return true;
}

std::string judge_hull(std::span<const PointF> points, const HullMesh& hull) {
  if (!std::is_sorted(hull.vertices.begin(), hull.vertices.end())) return "hull order";
  if (!std::is_sorted(hull.faces.begin(), hull.faces.end())) return "hull face order";
  for (const Triple& f : hull.faces)
    if (f[0] >= f[1] || f[0] >= f[2]) return "hull face start";
  switch (hull.dimension) {
    case 3:
      return judge_solid(points, hull);
    case 2:
      return judge_flat(points, hull);
    case 1: {
      if (hull.vertices.size() != 2 || !hull.faces.empty()) return "not a segment";
      const PointF& a = points[hull.vertices[0]];
      const PointF& b = points[hull.vertices[1]];
      for (const PointF& p : points)
        if (!in_line(a, b, p) || p < std::min(a, b) || std::max(a, b) < p) return "off the segment";
      return a == b ? "no segment" : "";
    }
    default:
      for (const PointF& p : points)
        if (p != points[hull.vertices.at(0)]) return "more than a point";
      return hull.vertices.size() == 1 && hull.faces.empty() ? "" : "not a point";
  }
}

}  // namespace palpate::test
