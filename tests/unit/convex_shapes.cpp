// SPDX-License-Identifier: Apache-2.0
#include "convex_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace palpate::convex::test {
namespace {

constexpr double kGrid = 1 << 20;

image::Vertex vertex(Vec3d p) {
  return {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}, 0};
}

__extension__ typedef __int128 Wide;
using Grid = Vec3<std::int64_t>;

/// Sign of the volume of the tetrahedron, exactly.
int side(const Grid& a, const Grid& b, const Grid& c, const Grid& d) {
  const Vec3<Wide> u = vec_cast<Wide>(b - a);
  const Vec3<Wide> v = vec_cast<Wide>(c - a);
  const Vec3<Wide> w = vec_cast<Wide>(d - a);
  const Wide volume = dot(cross(u, v), w);
  return volume > 0 ? 1 : (volume < 0 ? -1 : 0);
}

using Face = std::array<std::uint32_t, 3>;

/// Four points that span space, or none.
std::vector<std::uint32_t> spanning_points(const std::vector<Grid>& p) {
  std::vector<std::uint32_t> chosen{0};
  const auto count = static_cast<std::uint32_t>(p.size());
  for (std::uint32_t i = 1; i < count && chosen.size() < 4; ++i) {
    const Vec3<Wide> u = vec_cast<Wide>(p[i] - p[0]);
    if (chosen.size() == 1 && !(squared_norm(u) == 0)) chosen.push_back(i);
    if (chosen.size() == 2 && i != chosen[1]) {
      const Vec3<Wide> n = cross(vec_cast<Wide>(p[chosen[1]] - p[0]), u);
      if (!(n == Vec3<Wide>{0, 0, 0})) chosen.push_back(i);
    }
    if (chosen.size() == 3 && i != chosen[2] && side(p[0], p[chosen[1]], p[chosen[2]], p[i]) != 0) {
      chosen.push_back(i);
    }
  }
  return chosen;
}

/// Incremental hull with exact tests, quadratic.
std::vector<Face> hull_faces(const std::vector<Grid>& p) {
  const std::vector<std::uint32_t> s = spanning_points(p);
  if (s.size() < 4) return {};
  std::vector<Face> faces;
  const bool turned = side(p[s[0]], p[s[1]], p[s[2]], p[s[3]]) > 0;
  const std::uint32_t b = turned ? s[2] : s[1];
  const std::uint32_t c = turned ? s[1] : s[2];
  faces = {{s[0], b, c}, {s[0], c, s[3]}, {s[0], s[3], b}, {b, s[3], c}};
  for (std::uint32_t i = 0; i < p.size(); ++i) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::vector<Face> kept;
    for (const Face& f : faces) {
      if (side(p[f[0]], p[f[1]], p[f[2]], p[i]) <= 0) {
        kept.push_back(f);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) edges.emplace(f[k], f[(k + 1) % 3]);
    }
    for (const auto& [u, v] : edges) {
      if (edges.count({v, u}) == 0) kept.push_back({u, v, i});
    }
    faces = std::move(kept);
  }
  return faces;
}

}  // namespace

Hull Shape::hull(double scale) const {
  Hull h;
  h.vertices = vertices.data();
  h.count = static_cast<std::uint32_t>(vertices.size());
  h.starts = starts.empty() ? nullptr : starts.data();
  h.neighbours = neighbours.empty() ? nullptr : neighbours.data();
  h.scale = scale;
  return h;
}

double uniform(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

Vec3d random_unit(Random& random) {
  const double z = uniform(random, -1, 1);
  const double angle = uniform(random, 0, 2 * std::numbers::pi);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

Quat about(Vec3d axis, double angle_rad) {
  const double s = std::sin(angle_rad / 2) / norm(axis);
  return {std::cos(angle_rad / 2), s * axis.x, s * axis.y, s * axis.z};
}

Quat random_rotation(Random& random) {
  return about(random_unit(random), uniform(random, 0, std::numbers::pi));
}

Shape cloud(const std::vector<Vec3d>& points) {
  Shape s;
  s.vertices.reserve(points.size());
  for (const Vec3d& p : points) s.vertices.push_back(vertex(p));
  return s;
}

Shape convex_hull(const std::vector<Vec3d>& points) {
  std::vector<Grid> grid;
  grid.reserve(points.size());
  for (const Vec3d& p : points) {
    grid.push_back(
        {std::llround(p.x * kGrid), std::llround(p.y * kGrid), std::llround(p.z * kGrid)});
  }
  std::vector<std::set<std::uint32_t>> joined(grid.size());
  for (const Face& f : hull_faces(grid)) {
    for (std::size_t k = 0; k < 3; ++k) {
      joined[f[k]].insert(f[(k + 1) % 3]);
      joined[f[(k + 1) % 3]].insert(f[k]);
    }
  }
  std::vector<std::uint32_t> renamed(grid.size());
  Shape s;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (joined[i].empty()) continue;
    renamed[i] = static_cast<std::uint32_t>(s.vertices.size());
    s.vertices.push_back(vertex((1 / kGrid) * vec_cast<double>(grid[i])));
  }
  if (s.vertices.size() <= image::kAdjacencyAbove) return s;
  s.starts.push_back(0);
  for (const auto& list : joined) {
    if (list.empty()) continue;
    for (const std::uint32_t n : list) s.neighbours.push_back(renamed[n]);
    s.starts.push_back(static_cast<std::uint32_t>(s.neighbours.size()));
  }
  return s;
}

Shape point(Vec3d p) { return cloud({p}); }
Shape segment(Vec3d p, Vec3d q) { return cloud({p, q}); }
Shape triangle(Vec3d p, Vec3d q, Vec3d r) { return cloud({p, q, r}); }

Shape box(Vec3d half) {
  std::vector<Vec3d> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i) {
    corners.push_back({(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                       (i & 4) != 0 ? half.z : -half.z});
  }
  return cloud(corners);
}

Shape prism(std::uint32_t sides, double radius, double half_height) {
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (const double z : {-half_height, half_height}) {
      points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  return convex_hull(points);
}

Shape ellipsoid(std::uint32_t count, Vec3d half, Random& random) {
  std::vector<Vec3d> points;
  points.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3d u = random_unit(random);
    points.push_back({half.x * u.x, half.y * u.y, half.z * u.z});
  }
  if (count <= image::kAdjacencyAbove) return cloud(points);
  return convex_hull(points);
}

Shape cap(std::uint32_t count, double radius, Random& random) {
  std::vector<Vec3d> points;
  const Vec3d centre = 0.3 * random_unit(random);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double r = radius * std::sqrt(uniform(random, 0, 1));
    const double angle = uniform(random, 0, 2 * std::numbers::pi);
    points.push_back(
        centre + Vec3d{r * std::cos(angle), r * std::sin(angle), 0.5 * (std::sqrt(1 - r * r) - 1)});
  }
  if (count <= image::kAdjacencyAbove) return cloud(points);
  return convex_hull(points);
}

Shape any_shape(std::uint32_t max_vertices, Random& random) {
  const auto count = static_cast<std::uint32_t>(
      std::pow(static_cast<double>(max_vertices), uniform(random, 0, 1)));
  const auto size = [&random] { return std::pow(10.0, uniform(random, -6, -0.1)); };
  switch (random() % 8) {
    case 0:
      return point(0.9 * random_unit(random));
    case 1:
      return segment(0.9 * random_unit(random), 0.9 * random_unit(random));
    case 2:
      return triangle(0.9 * random_unit(random), 0.9 * random_unit(random),
                      0.9 * random_unit(random));
    case 3: {  // a needle or sliver far from the origin
      const Vec3d p = 0.5 * random_unit(random);
      return triangle(p, p + 0.4 * random_unit(random), p + size() * random_unit(random));
    }
    case 4:
      return box({0.5 * size(), 0.5, 0.5 * size()});
    case 5:
      return prism(3 + static_cast<std::uint32_t>(random() % 14), 0.5, 0.6 * size());
    case 6:
      return max_vertices > 60 ? cap(count + 4, 0.02, random) : cap(count, 0.02, random);
    default:
      return ellipsoid(count < 1 ? 1 : count, {0.9, 0.9 * size() + 0.02, 0.3}, random);
  }
}

Real real_a(const Hull& a, std::uint32_t i) {
  const float* p = a.vertices[i].position;
  return static_cast<long double>(a.scale) * vec_cast<long double>(Vec3f{p[0], p[1], p[2]});
}

Real real_b(const Hull& b, const RelativePose& b_in_a, std::uint32_t i) {
  const Mat3<long double> rotation{vec_cast<long double>(b_in_a.rotation.row0),
                                   vec_cast<long double>(b_in_a.rotation.row1),
                                   vec_cast<long double>(b_in_a.rotation.row2)};
  return rotation * real_a(b, i) + vec_cast<long double>(b_in_a.translation);
}

long double gap_along(const Hull& a, const Hull& b, const RelativePose& b_in_a, Vec3d normal) {
  const Real n = vec_cast<long double>(normal);
  long double lowest_a = std::numeric_limits<long double>::infinity();
  long double highest_b = -lowest_a;
  for (std::uint32_t i = 0; i < a.count; ++i) lowest_a = std::min(lowest_a, dot(n, real_a(a, i)));
  for (std::uint32_t i = 0; i < b.count; ++i) {
    highest_b = std::max(highest_b, dot(n, real_b(b, b_in_a, i)));
  }
  return (lowest_a - highest_b) / std::sqrt(squared_norm(n));
}

namespace {

long double length(Real p) { return std::sqrt(squared_norm(p)); }
long double length(Vec3d p) { return length(vec_cast<long double>(p)); }

/// Is the origin inside the cached simplex, but for `slack`?
bool holds_origin(const Hull& a, const Hull& b, const RelativePose& b_in_a, const Cache& cache,
                  long double slack) {
  if (cache.count != 4) return false;
  Real p[4];
  for (int i = 0; i < 4; ++i) p[i] = real_a(a, cache.a[i]) - real_b(b, b_in_a, cache.b[i]);
  constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  for (const auto& f : kFaces) {
    const Real n = cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]);
    const long double inner = dot(n, p[f[3]] - p[f[0]]);
    const long double origin = -dot(n, p[f[0]]);
    if ((inner > 0 ? origin : -origin) < -slack * length(n)) return false;
  }
  return true;
}

template <class Point>
bool combines(std::uint32_t count, const std::uint32_t (&vertices)[3], const double (&weights)[3],
              Vec3d stated, long double slack, Point&& point_of) {
  if (count < 1 || count > 3) return false;
  long double sum = 0;
  Real p;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t k = 0; k < i; ++k) {
      if (vertices[k] == vertices[i]) return false;
    }
    if (!(weights[i] > 0)) return false;
    const auto weight = static_cast<long double>(weights[i]);
    sum += weight;
    p += weight * point_of(vertices[i]);
  }
  return std::abs(sum - 1) < 1e-14L && length(p - vec_cast<long double>(stated)) <= slack;
}

}  // namespace

const char* refute(const Hull& a, const Hull& b, const RelativePose& b_in_a, const Distance& d,
                   const Cache& cache) {
  const auto unit = static_cast<long double>(a.scale + b.scale);
  const long double slack = 1e-15L * (unit + length(b_in_a.translation));
  const auto stated = static_cast<long double>(d.distance);
  const auto lower = static_cast<long double>(d.lower_bound);
  const auto touching = static_cast<long double>(kTouching);
  if (!std::isfinite(d.distance) || !std::isfinite(d.lower_bound)) return "not finite";
  if (!(d.lower_bound >= 0) || d.lower_bound > d.distance) return "bounds out of order";
  if (d.state == State::gave_up) return "gave up";
  if (d.state == State::penetrating) {
    if (d.distance != 0) return "penetrating at a distance";
    const bool held = holds_origin(a, b, b_in_a, cache, 31 * touching * unit + slack);
    return held ? nullptr : "penetration not proved";
  }
  const auto of_a = [&a](std::uint32_t i) { return real_a(a, i); };
  const auto of_b = [&](std::uint32_t i) { return real_b(b, b_in_a, i); };
  if (!combines(d.count_a, d.vertices_a, d.weights_a, d.point_a, slack, of_a))
    return "witness of a";
  if (!combines(d.count_b, d.vertices_b, d.weights_b, d.point_b, slack, of_b))
    return "witness of b";
  const long double apart =
      length(vec_cast<long double>(d.point_a) - vec_cast<long double>(d.point_b));
  if (std::abs(apart - stated) > slack) return "distance is not that of the witnesses";
  if (std::abs(length(d.normal) - 1) > 1e-14L) return "normal is not of unit length";
  const long double gap = gap_along(a, b, b_in_a, d.normal);
  if (lower > 0 && lower > gap) return "lower bound above the gap along the normal";
  if (d.state == State::touching) {
    return stated <= 1e-7L * unit && gap >= -1.01e-7L * unit ? nullptr : "touching not proved";
  }
  if (!(d.lower_bound > 0)) return "separated without a gap";
  return stated - gap <= 1e-7L * (unit + stated) ? nullptr : "distance is too large";
}

}  // namespace palpate::convex::test
