// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/surface_edges.hpp"

#include <span>

#include "host_bake/hull/predicates.hpp"
#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {
namespace {

std::uint32_t half_edge_of(const NormalMesh& mesh, const Side& side) {
  const std::uint32_t start = side.forward ? side.low : side.high;
  return 3 * side.face + corner_of(mesh.faces[side.face], start);
}

EdgeKind classify(const NormalMesh& mesh, const SurfaceEdges& edges, std::size_t h) {
  const std::size_t t = edges.twin[h];
  if (edges.degenerate[h / 3] || edges.degenerate[t / 3]) return EdgeKind::convex;
  const PointF& a = mesh.points[edge_start(mesh, h)];
  const PointF& b = mesh.points[edge_end(mesh, h)];
  const PointF& c = mesh.points[edge_apex(mesh, h)];
  const PointF& d = mesh.points[edge_apex(mesh, t)];
  const int side = orient_3d(a, b, c, d);
  if (side != 0) return side > 0 ? EdgeKind::reflex : EdgeKind::convex;
  // In one plane: flat where the apices lie on either side of the edge, folded where on the same.
  return turn(b, a, d, projection_of(a, b, c)) > 0 ? EdgeKind::flat : EdgeKind::reflex;
}

}  // namespace

SurfaceEdges surface_edges(const NormalMesh& mesh) {
  SurfaceEdges edges;
  edges.degenerate.reserve(mesh.faces.size());
  for (const Face& f : mesh.faces)
    edges.degenerate.push_back(
        collinear(mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]) ? 1 : 0);

  edges.twin.assign(mesh.faces.size() * 3, SurfaceEdges::kNone);
  const std::vector<Side> sides = sorted_sides(mesh.faces);
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2 || edge[0].forward == edge[1].forward) return;
    const std::uint32_t h = half_edge_of(mesh, edge[0]);
    const std::uint32_t t = half_edge_of(mesh, edge[1]);
    edges.twin[h] = t;
    edges.twin[t] = h;
  });

  edges.kind.assign(edges.twin.size(), EdgeKind::boundary);
  for (std::size_t h = 0; h < edges.twin.size(); ++h) {
    const std::uint32_t t = edges.twin[h];
    if (t != SurfaceEdges::kNone && h < t) edges.kind[h] = edges.kind[t] = classify(mesh, edges, h);
  }
  return edges;
}

std::vector<std::uint32_t> crest_distance(const SurfaceEdges& edges) {
  std::vector<std::uint32_t> distance(edges.degenerate.size(), SurfaceEdges::kNone);
  std::vector<std::uint32_t> queue;
  for (std::uint32_t f = 0; f < distance.size(); ++f)
    for (std::size_t h = 3 * std::size_t{f}; h < 3 * std::size_t{f} + 3; ++h)
      if (!edges.crossable(h) && distance[f] != 0) {
        distance[f] = 0;
        queue.push_back(f);
      }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::uint32_t f = queue[head];
    for (std::size_t h = 3 * std::size_t{f}; h < 3 * std::size_t{f} + 3; ++h) {
      if (edges.twin[h] == SurfaceEdges::kNone) continue;
      const std::uint32_t g = edges.twin[h] / 3;
      if (distance[g] != SurfaceEdges::kNone) continue;
      distance[g] = distance[f] + 1;
      queue.push_back(g);
    }
  }
  return distance;
}

}  // namespace palpate::bake
