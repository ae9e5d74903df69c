// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hull/facets.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <numeric>

namespace palpate::bake {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::size_t next_corner(std::size_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

/// The closed triangulation with half-edges 3 f + i from corner i to corner i + 1 of face f.
struct Surface {
  std::vector<std::uint32_t> vertices;  // ascending; faces use positions in it
  std::vector<Triangle> faces;
  std::vector<std::uint32_t> twin;

  [[nodiscard]] std::uint32_t from(std::size_t h) const { return faces[h / 3][h % 3]; }
  [[nodiscard]] std::uint32_t to(std::size_t h) const { return from(next_corner(h)); }
};

void pair_half_edges(Surface& surface) {
  struct Key {
    std::uint64_t ends;
    std::uint32_t half_edge;
  };
  std::vector<Key> keys;
  keys.reserve(surface.faces.size() * 3);
  for (std::uint32_t h = 0; h < surface.faces.size() * 3; ++h) {
    const std::uint64_t a = surface.from(h);
    const std::uint64_t b = surface.to(h);
    keys.push_back({std::min(a, b) << 32 | std::max(a, b), h});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a.ends < b.ends; });
  surface.twin.assign(keys.size(), kNone);
  for (std::size_t k = 0; k + 1 < keys.size(); k += 2) {
    assert(keys[k].ends == keys[k + 1].ends);
    surface.twin[keys[k].half_edge] = keys[k + 1].half_edge;
    surface.twin[keys[k + 1].half_edge] = keys[k].half_edge;
  }
}

Surface make_surface(std::span<const Triangle> triangles) {
  Surface surface;
  for (const Triangle& t : triangles)
    surface.vertices.insert(surface.vertices.end(), t.begin(), t.end());
  std::sort(surface.vertices.begin(), surface.vertices.end());
  surface.vertices.erase(std::unique(surface.vertices.begin(), surface.vertices.end()),
                         surface.vertices.end());
  for (const Triangle& t : triangles) {
    Triangle& face = surface.faces.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
      face[i] = static_cast<std::uint32_t>(
          std::lower_bound(surface.vertices.begin(), surface.vertices.end(), t[i]) -
          surface.vertices.begin());
  }
  pair_half_edges(surface);
  return surface;
}

/// 1 for half-edges between two facets, 0 for those inside one.
std::vector<char> find_borders(std::span<const PointF> points, const Surface& surface) {
  std::vector<char> border(surface.twin.size(), 1);
  const auto point = [&](std::uint32_t v) { return points[surface.vertices[v]]; };
  for (std::size_t h = 0; h < border.size(); ++h) {
    const std::size_t t = surface.twin[h];
    if (t < h) continue;
    const Triangle& face = surface.faces[h / 3];
    const std::uint32_t apex = surface.to(next_corner(t));
    if (orient_3d(point(face[0]), point(face[1]), point(face[2]), point(apex)) == 0)
      border[h] = border[t] = 0;
  }
  return border;
}

/// The facet's border after half-edge `h`: turns about its end over the half-edges inside the
/// facet.
std::size_t next_on_border(const Surface& surface, const std::vector<char>& border, std::size_t h) {
  std::size_t n = next_corner(h);
  while (!border[n]) n = next_corner(surface.twin[n]);
  return n;
}

/// A facet is a convex polygon whose least vertex is put first.
void append_fan(std::vector<std::uint32_t>& polygon, std::uint32_t facet,
                std::vector<std::array<std::uint32_t, 4>>& out_faces) {
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    out_faces.push_back({polygon[0], polygon[i], polygon[i + 1], facet});
}

}  // namespace

FacetHull canonical_hull(std::span<const PointF> points, std::span<const Triangle> triangles) {
  const Surface surface = make_surface(triangles);
  std::vector<char> border = find_borders(points, surface);

  // As many facets meet at a vertex as border half-edges leave it: one inside a facet, two on an
  // edge.
  std::vector<std::uint32_t> facets_at(surface.vertices.size(), 0);
  for (std::size_t h = 0; h < border.size(); ++h)
    if (border[h]) ++facets_at[surface.from(h)];

  FacetHull hull;
  std::vector<std::uint32_t> new_index(surface.vertices.size(), kNone);
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    if (facets_at[v] < 3) continue;
    new_index[v] = static_cast<std::uint32_t>(hull.mesh.vertices.size());
    hull.mesh.vertices.push_back(surface.vertices[v]);
  }

  std::vector<std::array<std::uint32_t, 4>> faces;
  std::vector<std::uint32_t> polygon;
  std::vector<char> done(border.size(), 0);
  for (std::size_t start = 0; start < border.size(); ++start) {
    if (!border[start] || done[start]) continue;
    polygon.clear();
    std::size_t h = start;
    do {
      done[h] = 1;
      if (new_index[surface.from(h)] != kNone) polygon.push_back(new_index[surface.from(h)]);
      h = next_on_border(surface, border, h);
    } while (h != start);
    append_fan(polygon, hull.facets++, faces);
  }
  std::sort(faces.begin(), faces.end());
  for (const auto& face : faces) {
    hull.mesh.faces.push_back({face[0], face[1], face[2]});
    hull.facet_of_face.push_back(face[3]);
  }
  return hull;
}

std::vector<std::uint32_t> flat_ring(std::span<const PointF> points, std::vector<std::uint32_t> ids,
                                     Projection view) {
  std::sort(ids.begin(), ids.end(), [&](std::uint32_t a, std::uint32_t b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  ids.erase(std::unique(ids.begin(), ids.end(),
                        [&](std::uint32_t a, std::uint32_t b) { return points[a] == points[b]; }),
            ids.end());
  if (view.facing == 0 && ids.size() > 2) ids = {ids.front(), ids.back()};
  if (ids.size() < 3) {
    std::sort(ids.begin(), ids.end());
    return ids;
  }

  // Monotone chain (Andrew 1979): along the sorted points and back.
  std::vector<std::uint32_t> ring;
  const auto add = [&](std::uint32_t id, std::size_t keep) {
    while (ring.size() > keep &&
           turn(points[ring[ring.size() - 2]], points[ring.back()], points[id], view) <= 0)
      ring.pop_back();
    ring.push_back(id);
  };
  for (const std::uint32_t id : ids) add(id, 1);
  const std::size_t keep = ring.size();
  for (std::size_t i = ids.size() - 1; i-- > 0;) add(ids[i], keep);
  ring.pop_back();
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

HullMesh canonical_flat_hull(std::span<const std::uint32_t> ring) {
  HullMesh hull;
  hull.dimension = static_cast<int>(std::min<std::size_t>(ring.size(), 3)) - 1;
  hull.vertices.assign(ring.begin(), ring.end());
  std::sort(hull.vertices.begin(), hull.vertices.end());
  std::vector<std::uint32_t> polygon;
  for (const std::uint32_t v : ring)
    polygon.push_back(static_cast<std::uint32_t>(
        std::lower_bound(hull.vertices.begin(), hull.vertices.end(), v) - hull.vertices.begin()));
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    hull.faces.push_back({polygon[0], polygon[i], polygon[i + 1]});
    hull.faces.push_back({polygon[0], polygon[i + 1], polygon[i]});
  }
  std::sort(hull.faces.begin(), hull.faces.end());
  return hull;
}

}  // namespace palpate::bake
