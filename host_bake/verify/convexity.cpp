// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints 1 and 2 of Sec. 4.3.
#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "host_bake/metrics/exact.hpp"
#include "host_bake/pack/adjacency.hpp"
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

// A directed edge of a triangle and the triangle's third vertex, keyed by its ends without order.
struct Side {
  std::uint32_t low, high;
  bool reversed;
  std::uint32_t opposite;
  std::uint32_t triangle;
  bool operator<(const Side& o) const {
    return std::tie(low, high, reversed, triangle) <
           std::tie(o.low, o.high, o.reversed, o.triangle);
  }
};

std::vector<Side> sides_of(std::span<const image::Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& v = triangles[t].vertices;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = v[i], to = v[(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), from > to, v[(i + 2) % 3], t});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::string reflex_edge(const std::vector<PointF>& points,
                        std::span<const image::Triangle> triangles) {
  const std::vector<Side> sides = sides_of(triangles);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.low != b.low || a.high != b.high) continue;
    const std::string edge = std::to_string(a.low) + "-" + std::to_string(a.high);
    if (a.reversed == b.reversed) return "edge " + edge + " is run through twice in one direction";
    const auto& v = triangles[a.triangle].vertices;
    if (side_of_plane(points[v[0]], points[v[1]], points[v[2]], points[b.opposite]) > 0) {
      return "edge " + edge + " is reflex";
    }
  }
  return {};
}

// Vertices among which one above the plane of a triangle with hull vertex `corner` has to be found
// where there is one at all: the neighbours of the corner, for a hull that is not above a plane
// next to one of its points on the plane is nowhere above it.
std::span<const std::uint32_t> neighbours_of(const Adjacency& joined, std::uint32_t corner) {
  return std::span(joined.neighbours)
      .subspan(joined.starts[corner], joined.starts[corner + 1] - joined.starts[corner]);
}

std::string visible_vertex(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  const std::vector<PointF>& points = evidence.points[index];
  const HullMesh& hull = evidence.hulls[index];
  const Adjacency joined = adjacency(hull.faces, piece.hull_vertices);
  std::vector<std::uint32_t> all(piece.vertices);
  std::iota(all.begin(), all.end(), 0u);
  for (const image::Triangle& t : patch(evidence, piece)) {
    const auto& v = t.vertices;
    const auto* corner = std::find_if(std::begin(v), std::end(v), [&](std::uint32_t c) {
      return c < piece.hull_vertices && !neighbours_of(joined, c).empty();
    });
    const std::span<const std::uint32_t> suspects =
        corner == std::end(v) || piece.vertices <= image::kAdjacencyAbove
            ? std::span<const std::uint32_t>(all)
            : neighbours_of(joined, *corner);
    for (const std::uint32_t s : suspects) {
      if (side_of_plane(points[v[0]], points[v[1]], points[v[2]], points[s]) > 0) {
        return "vertex " + std::to_string(s) + " is above triangle " +
               std::to_string(&t - patch(evidence, piece).data());
      }
    }
  }
  return {};
}

}  // namespace

Proof prove_interior_edges_convex(const Evidence& evidence) {
  return prove_each(
      "no interior edge of a patch is reflex", evidence.hulls.size(), [&](std::uint32_t i) {
        return reflex_edge(evidence.points[i], patch(evidence, evidence.image.pieces[i]));
      });
}

Proof prove_no_vertex_visible(const Evidence& evidence) {
  return prove_each("no vertex is visible from a triangle of its patch", evidence.hulls.size(),
                    [&](std::uint32_t i) { return visible_vertex(evidence, i); });
}

}  // namespace palpate::bake
