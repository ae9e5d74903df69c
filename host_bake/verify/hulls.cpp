// SPDX-License-Identifier: GPL-3.0-or-later
// Each hull by itself: its vertices, its neighbour lists, its sphere.
#include <algorithm>
#include <map>
#include <vector>

#include "host_bake/metrics/exact.hpp"
#include "host_bake/pack/adjacency.hpp"
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

using Corner = std::uint32_t;

std::string not_extreme(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  if (evidence.hulls[index].vertices.size() != piece.hull_vertices) {
    return std::to_string(piece.hull_vertices) + " hull vertices, " +
           std::to_string(evidence.hulls[index].vertices.size()) + " are extreme";
  }
  const std::vector<PointF>& points = evidence.points[index];
  if (piece.vertices > piece.hull_vertices &&
      convex_hull(points).vertices != evidence.hulls[index].vertices) {
    return "a vertex beyond the hull vertices is outside the hull";
  }
  return {};
}

// Both ends of a hull edge that two facets meet in, or of a diagonal inside a facet.
struct Edge {
  Corner from, to;
  auto operator<=>(const Edge&) const = default;
};

// The edges of the hull's triangles, each way, with the third vertex of the triangle.
std::map<Edge, Corner> directed_edges(const HullMesh& hull) {
  std::map<Edge, Corner> edges;
  for (const auto& f : hull.faces) {
    for (std::size_t i = 0; i < 3; ++i) edges[{f[i], f[(i + 1) % 3]}] = f[(i + 2) % 3];
  }
  return edges;
}

bool share_a_facet(const Evidence& evidence, std::uint32_t index,
                   const std::map<Edge, Corner>& edges, Edge edge) {
  const std::vector<PointF>& p = evidence.points[index];
  for (auto it = edges.lower_bound({edge.from, 0});
       it != edges.end() && it->first.from == edge.from; ++it) {
    if (side_of_plane(p[edge.from], p[it->first.to], p[it->second], p[edge.to]) == 0) return true;
  }
  return false;
}

std::string wrong_adjacency(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  if (piece.first_neighbour_start == image::kNone) return {};
  const std::vector<PointF>& p = evidence.points[index];
  const std::map<Edge, Corner> edges = directed_edges(evidence.hulls[index]);
  const auto listed = [&](Edge e) {
    const std::uint32_t* starts =
        &evidence.image.neighbour_starts[piece.first_neighbour_start + e.from];
    const std::uint32_t* first = evidence.image.neighbours.data() + piece.first_neighbour;
    return std::binary_search(first + starts[0], first + starts[1], e.to);
  };
  for (const auto& [edge, third] : edges) {
    const Corner across = edges.at({edge.to, edge.from});
    const bool flat = side_of_plane(p[edge.from], p[edge.to], p[third], p[across]) == 0;
    if (!flat && !listed(edge)) {
      return "edge " + std::to_string(edge.from) + "-" + std::to_string(edge.to) + " is not listed";
    }
  }
  for (Corner from = 0; from < piece.hull_vertices; ++from) {
    const std::uint32_t* starts =
        &evidence.image.neighbour_starts[piece.first_neighbour_start + from];
    for (std::uint32_t i = starts[0]; i < starts[1]; ++i) {
      const Edge edge{from, evidence.image.neighbours[piece.first_neighbour + i]};
      const std::string name = std::to_string(edge.from) + "-" + std::to_string(edge.to);
      if (!listed({edge.to, edge.from})) return "edge " + name + " is listed one way only";
      if (!share_a_facet(evidence, index, edges, edge))
        return "edge " + name + " is not of the hull";
    }
  }
  return {};
}

std::string outside_sphere(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  const ExactKernel::Point_3 centre = exact({piece.centre[0], piece.centre[1], piece.centre[2]});
  // The square of a float is exact in double.
  const double squared_radius =
      static_cast<double>(piece.radius) * static_cast<double>(piece.radius);
  for (const PointF& p : hull_points(evidence, index)) {
    if (CGAL::compare_squared_distance(centre, exact(p), squared_radius) == CGAL::LARGER) {
      return "a hull vertex is outside the sphere";
    }
  }
  return {};
}

}  // namespace

Proof prove_hull_vertices_extreme(const Evidence& evidence) {
  return prove_each("hull vertices are the extreme points", evidence.hulls.size(),
                    [&](std::uint32_t i) { return not_extreme(evidence, i); });
}

Proof prove_adjacency(const Evidence& evidence) {
  return prove_each("neighbours are the hull's edges", evidence.hulls.size(),
                    [&](std::uint32_t i) { return wrong_adjacency(evidence, i); });
}

Proof prove_spheres_contain(const Evidence& evidence) {
  return prove_each("spheres contain their hulls", evidence.hulls.size(),
                    [&](std::uint32_t i) { return outside_sphere(evidence, i); });
}

}  // namespace palpate::bake
