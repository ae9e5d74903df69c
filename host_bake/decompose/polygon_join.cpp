// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/polygon_join.hpp"

#include <algorithm>
#include <cstddef>

#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {

PolygonJoin::PolygonJoin(const NormalMesh& mesh, const SurfaceEdges& edges)
    : mesh_(mesh),
      edges_(edges),
      next_(edges.twin.size()),
      previous_(edges.twin.size()),
      size_(mesh.faces.size(), 1) {
  for (std::uint32_t h = 0; h < next_.size(); ++h) {
    next_[h] = h % 3 == 2 ? h - 2 : h + 1;
    previous_[h] = h % 3 == 0 ? h + 2 : h - 1;
  }
}

bool PolygonJoin::twins(std::uint32_t h, std::uint32_t t) const {
  return edges_.twin[h] == t && edges_.kind[h] == EdgeKind::flat;
}

PolygonJoin::Chain PolygonJoin::common_border(std::uint32_t h) const {
  const std::uint32_t t = edges_.twin[h];
  Chain chain{h, h};
  for (std::uint32_t s = t; twins(previous_[chain.first], next_[s]); s = next_[s])
    chain.first = previous_[chain.first];
  for (std::uint32_t s = t; twins(next_[chain.last], previous_[s]); s = previous_[s])
    chain.last = next_[chain.last];
  return chain;
}

/// The joined polygon's corner where half-edge `into` ends and `out` starts is convex.
bool PolygonJoin::straight_or_left(std::uint32_t into, std::uint32_t out) const {
  const PointF& a = mesh_.points[edge_start(mesh_, into)];
  const PointF& b = mesh_.points[edge_start(mesh_, out)];
  const PointF& c = mesh_.points[edge_end(mesh_, out)];
  const int sign = turn(a, b, c, view_);
  // In line may also mean a full turn, back along a slit.
  return sign > 0 || (sign == 0 && dot(position(b) - position(a), position(c) - position(b)) > 0);
}

bool PolygonJoin::join(std::uint32_t h, std::uint32_t most_faces, Sets& group) {
  const std::uint32_t a = group.find(h / 3);
  const std::uint32_t b = group.find(edges_.twin[h] / 3);
  if (a == b || size_[a] + size_[b] > most_faces) return false;
  const Chain chain = common_border(h);
  const std::uint32_t into_start = previous_[chain.first];
  const std::uint32_t out_of_start = next_[edges_.twin[chain.first]];
  const std::uint32_t into_end = previous_[edges_.twin[chain.last]];
  const std::uint32_t out_of_end = next_[chain.last];
  if (!straight_or_left(into_start, out_of_start) || !straight_or_left(into_end, out_of_end))
    return false;
  next_[into_start] = out_of_start;
  previous_[out_of_start] = into_start;
  next_[into_end] = out_of_end;
  previous_[out_of_end] = into_end;
  const std::uint32_t size = size_[a] + size_[b];
  group.join(a, b);
  size_[group.find(a)] = size;
  return true;
}

void PolygonJoin::run(std::span<const std::uint32_t> faces, std::uint32_t most_faces, Sets& group) {
  const Face& first = mesh_.faces[faces.front()];
  view_ = projection_of(mesh_.points[first[0]], mesh_.points[first[1]], mesh_.points[first[2]]);

  struct Candidate {
    double squared_length;
    std::uint32_t half_edge;
  };
  std::vector<Candidate> left;
  for (const std::uint32_t f : faces)
    for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h)
      if (edges_.kind[h] == EdgeKind::flat && h < edges_.twin[h])
        left.push_back({squared_norm(position(mesh_, edge_end(mesh_, h)) -
                                     position(mesh_, edge_start(mesh_, h))),
                        h});
  std::sort(left.begin(), left.end(), [](const Candidate& a, const Candidate& b) {
    return a.squared_length != b.squared_length ? a.squared_length > b.squared_length
                                                : a.half_edge < b.half_edge;
  });
  for (bool joined = true; joined;) {
    joined = false;
    std::erase_if(left, [&](const Candidate& c) {
      if (join(c.half_edge, most_faces, group)) {
        joined = true;
        return true;
      }
      return group.find(c.half_edge / 3) == group.find(edges_.twin[c.half_edge] / 3);
    });
  }
}

}  // namespace palpate::bake
