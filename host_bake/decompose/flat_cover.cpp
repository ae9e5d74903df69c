// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/flat_cover.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {
namespace {

using Flat = std::array<double, 2>;

double turn_of(const Flat& a, const Flat& b, const Flat& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Counter-clockwise (Andrew's monotone chain, 1979).
std::vector<Flat> convex_polygon(std::vector<Flat> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Flat> ring;
  const auto add = [&](const Flat& p, std::size_t keep) {
    while (ring.size() > keep && turn_of(ring[ring.size() - 2], ring.back(), p) <= 0)
      ring.pop_back();
    ring.push_back(p);
  };
  for (const Flat& p : points) add(p, 1);
  const std::size_t keep = ring.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], keep);
  ring.pop_back();
  return ring;
}

struct Measure {
  double area = 0;
  double perimeter = 0;
};

Measure measure(const std::vector<Flat>& ring) {
  Measure m;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Flat& a = ring[i];
    const Flat& b = ring[(i + 1) % ring.size()];
    m.area += turn_of(ring[0], a, b) / 2;
    m.perimeter += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  return m;
}

/// Of a point in the polygon: not farther than kShrink_rel from its border.
bool near_border(const std::vector<Flat>& ring, const Flat& p) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Flat& a = ring[i];
    const Flat& b = ring[(i + 1) % ring.size()];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (turn_of(a, b, p) <= kShrink_rel * length) return true;
  }
  return false;
}

std::vector<Flat> border_points(const NormalMesh& mesh, const SurfaceEdges& edges,
                                std::span<const std::uint32_t> faces,
                                std::span<const std::uint32_t> owner, std::uint32_t id,
                                Vec3d normal) {
  const Vec3d across = any_perpendicular(normal);
  const Vec3d along = cross(normal, across);
  std::vector<Flat> border;
  for (const std::uint32_t f : faces)
    for (std::size_t h = 3 * std::size_t{f}; h < 3 * std::size_t{f} + 3; ++h) {
      if (edges.twin[h] != SurfaceEdges::kNone && owner[edges.twin[h] / 3] == id) continue;
      const Vec3d p = position(mesh, edge_start(mesh, h));
      border.push_back({dot(across, p), dot(along, p)});
    }
  return border;
}

}  // namespace

bool fills_convex_polygon(const NormalMesh& mesh, const SurfaceEdges& edges,
                          std::span<const std::uint32_t> faces,
                          std::span<const std::uint32_t> owner, std::uint32_t id) {
  Vec3d twice_area{};
  for (const std::uint32_t f : faces) twice_area += area_vector(mesh, mesh.faces[f]);
  const double size = norm(twice_area);
  if (size == 0) return false;
  const Vec3d normal = (1 / size) * twice_area;
  for (const std::uint32_t f : faces)
    if (dot(normal, area_vector(mesh, mesh.faces[f])) < 0) return false;

  const std::vector<Flat> border = border_points(mesh, edges, faces, owner, id, normal);
  if (border.size() < 3) return false;  // closed: both sides of something
  const std::vector<Flat> ring = convex_polygon(border);
  const Measure polygon = measure(ring);
  // With the border along the polygon's own, equal areas leave no room for holes and overlaps.
  if (std::abs(polygon.area - size / 2) > kShrink_rel * polygon.perimeter) return false;
  return std::all_of(border.begin(), border.end(),
                     [&](const Flat& p) { return near_border(ring, p); });
}

}  // namespace palpate::bake
