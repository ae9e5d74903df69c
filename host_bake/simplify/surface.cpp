// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/surface.hpp"

#include <algorithm>
#include <cassert>
#include <span>

#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {
namespace {

std::uint32_t half_edge_of(const std::vector<Face>& faces, const Side& side) {
  return 3 * side.face + corner_of(faces[side.face], side.forward ? side.low : side.high);
}

}  // namespace

Surface::Surface(const NormalMesh& mesh)
    : points(mesh.points),
      faces(mesh.faces),
      twin(3 * mesh.faces.size(), kNothing),
      living_faces(static_cast<std::uint32_t>(mesh.faces.size())),
      leaving_(mesh.points.size(), kNothing) {
  const std::vector<Side> sides = sorted_sides(faces);
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2 || edge[0].forward == edge[1].forward) return;
    const std::uint32_t h = half_edge_of(faces, edge[0]);
    const std::uint32_t t = half_edge_of(faces, edge[1]);
    twin[h] = t;
    twin[t] = h;
  });
  for (std::uint32_t h = 0; h < twin.size(); ++h) leaving_[start(h)] = h;
}

bool Surface::on_boundary(std::uint32_t v) const {
  const std::uint32_t first = leaving_[v];
  std::uint32_t h = first;
  do {
    if (twin[h] == kNothing) return true;
    h = next(twin[h]);
  } while (h != first);
  return false;
}

void Surface::find_fan(std::uint32_t v, std::vector<std::uint32_t>& out_half_edges) const {
  out_half_edges.clear();
  std::uint32_t h = leaving_[v];
  while (twin[h] != kNothing) {
    h = next(twin[h]);
    if (h == leaving_[v]) break;
  }
  const std::uint32_t first = h;
  do {
    out_half_edges.push_back(h);
    h = twin[previous(h)];
  } while (h != first && h != kNothing);
}

/// The next spoke counter-clockwise after the collapse: steps over the faces that go.
std::uint32_t Surface::turn_left(const Ring& ring, std::uint32_t spoke) const {
  const std::uint32_t n = twin[previous(spoke)];
  if (n == next(ring.edge)) return twin[previous(ring.edge)];
  if (ring.twin != kNothing && n == next(ring.twin)) return twin[previous(ring.twin)];
  return n;
}

std::uint32_t Surface::turn_right(const Ring& ring, std::uint32_t spoke) const {
  std::uint32_t m = twin[spoke];
  if (m == kNothing) return kNothing;
  if (m == previous(ring.edge)) {
    m = twin[next(ring.edge)];
  } else if (ring.twin != kNothing && m == previous(ring.twin)) {
    m = twin[next(ring.twin)];
  }
  return m == kNothing ? kNothing : next(m);
}

bool Surface::find_ring(std::uint32_t h, Ring& out_ring) const {
  Ring& ring = out_ring;
  ring.edge = h;
  ring.twin = twin[h];
  ring.kept = start(h);
  ring.removed = end(h);
  ring.spokes.clear();
  ring.vertices.clear();
  ring.far.clear();
  for (const std::uint32_t e : {ring.edge, ring.twin}) {
    // A face that hangs on this edge alone would leave its third vertex without faces.
    if (e != kNothing && twin[next(e)] == kNothing && twin[previous(e)] == kNothing) return false;
  }
  if (ring.twin != kNothing && on_boundary(ring.kept) && on_boundary(ring.removed)) return false;

  const std::uint32_t anchor =
      twin[previous(h)] != kNothing ? twin[previous(h)] : next(twin[next(h)]);
  std::uint32_t spoke = anchor;
  for (std::size_t i = 0; i <= kMaxRing; ++i) {
    const std::uint32_t r = turn_right(ring, spoke);
    if (r == kNothing || r == anchor) break;
    spoke = r;
  }
  ring.closed = turn_right(ring, spoke) != kNothing;
  const std::uint32_t first = spoke;
  do {
    if (ring.spokes.size() == kMaxRing) return false;
    ring.spokes.push_back(spoke);
    ring.vertices.push_back(end(spoke));
    ring.far.push_back(twin[next(spoke)]);
    spoke = turn_left(ring, spoke);
  } while (spoke != kNothing && spoke != first);
  if (!ring.closed) ring.vertices.push_back(apex(ring.spokes.back()));
  if (ring.closed && ring.spokes.size() < 3) return false;

  std::array<std::uint32_t, kMaxRing + 1> sorted;
  const auto last = std::copy(ring.vertices.begin(), ring.vertices.end(), sorted.begin());
  std::sort(sorted.begin(), last);
  return std::adjacent_find(sorted.begin(), last) == last;
}

void Surface::collapse(const Ring& ring, const PointF& position) {
  for (const std::uint32_t spoke : ring.spokes) faces[spoke / 3][spoke % 3] = ring.kept;
  for (const std::uint32_t e : {ring.edge, ring.twin}) {
    if (e == kNothing) continue;
    const std::uint32_t out = twin[previous(e)];
    const std::uint32_t in = twin[next(e)];
    if (out != kNothing) twin[out] = in;
    if (in != kNothing) twin[in] = out;
    leaving_[apex(e)] = in != kNothing ? in : next(out);
    faces[e / 3] = {kNothing, kNothing, kNothing};
    --living_faces;
  }
  leaving_[ring.kept] = ring.spokes.front();
  leaving_[ring.removed] = kNothing;
  points[ring.kept] = position;
}

}  // namespace palpate::bake
