// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/cracks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace palpate::bake {
namespace {

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<Side> open_sides(std::span<const Side> sides) {
  std::vector<Side> open;
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() == 1) open.push_back(edge[0]);
  });
  return open;
}

/// The ends of the edges, in the order of their coordinates.
std::vector<std::uint32_t> ends_of(const std::vector<Side>& edges,
                                   const std::vector<Point>& points) {
  std::vector<std::uint32_t> ends;
  for (const Side& edge : edges) ends.insert(ends.end(), {edge.low, edge.high});
  std::sort(ends.begin(), ends.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(points[a], a) < std::tie(points[b], b);
  });
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

Point low_of(const std::vector<Point>& points, const std::vector<std::uint32_t>& chosen) {
  Point low = points[chosen.front()];
  for (const std::uint32_t vertex : chosen) {
    for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], points[vertex][i]);
  }
  return low;
}

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t x : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Vertices farther than the reach from each other, in cells twice as wide: few share a cell
/// whatever the mesh, and what is in reach of a place is in the eight cells nearest to it.
class Grid {
 public:
  Grid(const std::vector<Point>& points, const Point& low, double reach)
      : points_(points), low_(low), reach_(reach) {}

  void add(std::uint32_t vertex) { vertices_[cell_of(points_[vertex], 0)].push_back(vertex); }

  /// The nearest one within reach, the first added of equally near ones; `vertex` itself where
  /// there is none.
  [[nodiscard]] std::uint32_t nearest(std::uint32_t vertex) const {
    const Point& p = points_[vertex];
    const Cell low = cell_of(p, -reach_);
    double least = reach_;
    std::uint32_t best = vertex;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const auto found = vertices_.find(
          {low[0] + (corner & 1U), low[1] + (corner >> 1U & 1U), low[2] + (corner >> 2U)});
      if (found == vertices_.end()) continue;
      for (const std::uint32_t other : found->second) {
        const double gap = distance(p, points_[other]);
        if (std::tie(gap, points_[other]) > std::tie(least, points_[best])) continue;
        least = gap;
        best = other;
      }
    }
    return best;
  }

 private:
  [[nodiscard]] Cell cell_of(const Point& p, double offset) const {
    Cell cell;
    for (std::size_t i = 0; i < 3; ++i) {
      cell[i] = static_cast<std::int64_t>(std::floor((p[i] - low_[i] + offset) / (2 * reach_)));
    }
    return cell;
  }

  const std::vector<Point>& points_;
  Point low_;
  double reach_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> vertices_;
};

/// For each vertex the one it coincides with within `reach`: itself, or one that comes before it in
/// the order of coordinates. Only those of `chosen`, which are in that order, are asked. The reach
/// is zero or at least kCoincideRel of the radius, so that cells are few enough to count.
std::vector<std::uint32_t> representatives(const std::vector<Point>& points,
                                           const std::vector<std::uint32_t>& chosen, double reach) {
  std::vector<std::uint32_t> of(points.size());
  for (std::uint32_t v = 0; v < of.size(); ++v) of[v] = v;
  if (!(reach > 0)) return of;
  Grid grid(points, low_of(points, chosen), reach);
  for (const std::uint32_t vertex : chosen) {
    of[vertex] = grid.nearest(vertex);
    if (of[vertex] == vertex) grid.add(vertex);
  }
  return of;
}

/// Drops the vertices that no face uses; the others are numbered by their first use.
void renumber(Mesh& mesh) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.points.size(), kUnused);
  std::vector<Point> points;
  for (Face& face : mesh.faces) {
    for (std::uint32_t& vertex : face) {
      if (number[vertex] == kUnused) {
        number[vertex] = static_cast<std::uint32_t>(points.size());
        points.push_back(mesh.points[vertex]);
      }
      vertex = number[vertex];
    }
  }
  mesh.points = std::move(points);
}

/// Half of the open edges are ten times as long as what this finds, whatever the size of a few.
double reach_for_cracks(const Mesh& mesh, const std::vector<Side>& open) {
  std::vector<double> lengths;
  lengths.reserve(open.size());
  for (const Side& side : open) {
    lengths.push_back(distance(mesh.points[side.low], mesh.points[side.high]));
  }
  const auto median = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), median, lengths.end());
  const double radius = radius_of(mesh);
  return std::clamp(kNearlyCoincideOfEdge * *median, kCoincideRel * radius,
                    kNearlyCoincideRel * radius);
}

/// An open edge by what its ends coincide with, and its own ends in the same order.
struct OpenEdge {
  std::array<std::uint32_t, 2> place, ends;
};

/// Edges of needles are left out: their two long sides are near each other on their own account.
std::vector<OpenEdge> by_place(const std::vector<Face>& faces, const std::vector<Side>& open,
                               const std::vector<std::uint32_t>& place) {
  std::vector<OpenEdge> edges;
  for (const Side& side : open) {
    const Face& face = faces[side.face];
    if (repeats_vertex({place[face[0]], place[face[1]], place[face[2]]})) continue;
    const std::uint32_t low = place[side.low], high = place[side.high];
    edges.push_back(low < high ? OpenEdge{{low, high}, {side.low, side.high}}
                               : OpenEdge{{high, low}, {side.high, side.low}});
  }
  std::sort(edges.begin(), edges.end(), [](const OpenEdge& a, const OpenEdge& b) {
    return std::tie(a.place, a.ends) < std::tie(b.place, b.ends);
  });
  return edges;
}

}  // namespace

Welded weld_coincident(Mesh& mesh) {
  Welded welded;
  const std::vector<Side> open = open_sides(sorted_sides(mesh.faces));
  if (open.empty()) return welded;
  const double radius = radius_of(mesh);
  const std::vector<std::uint32_t> ends = ends_of(open, mesh.points);
  const auto of = representatives(mesh.points, ends, kCoincideRel * radius);
  for (const std::uint32_t vertex : ends) {
    if (of[vertex] == vertex) continue;
    ++welded.corners;
    welded.largest_gap_m =
        std::max(welded.largest_gap_m, distance(mesh.points[vertex], mesh.points[of[vertex]]));
  }
  if (welded.corners == 0) return welded;
  welded.largest_gap_rel = welded.largest_gap_m / radius;
  welded.collapsed_triangles = std::erase_if(mesh.faces, [&](Face& face) {
    const bool degenerate = repeats_vertex(face);
    for (std::uint32_t& vertex : face) vertex = of[vertex];
    return !degenerate && repeats_vertex(face);
  });
  renumber(mesh);
  return welded;
}

std::string describe(const Welded& welded) {
  char gap[96];
  std::snprintf(gap, sizeof gap, ", largest gap %.2g m (%.2g of the radius)", welded.largest_gap_m,
                welded.largest_gap_rel);
  std::string text = std::to_string(welded.corners) + " corners that differed by rounding" + gap;
  if (welded.collapsed_triangles == 0) return text;
  return text + "; " + std::to_string(welded.collapsed_triangles) + " triangles collapsed and gone";
}

Cracks find_cracks(const Mesh& mesh, std::span<const Side> sides) {
  Cracks cracks;
  const std::vector<Side> open = open_sides(sides);
  if (open.empty()) return cracks;
  const auto place =
      representatives(mesh.points, ends_of(open, mesh.points), reach_for_cracks(mesh, open));
  const std::vector<OpenEdge> edges = by_place(mesh.faces, open, place);
  for (std::size_t i = 1, first = 0; i < edges.size(); ++i) {
    if (edges[i].place != edges[first].place) first = i;
    if (first == i) continue;
    const Point &a = mesh.points[edges[first].ends[0]], &b = mesh.points[edges[first].ends[1]];
    const Point &c = mesh.points[edges[i].ends[0]], &d = mesh.points[edges[i].ends[1]];
    const double gap = std::max(distance(a, c), distance(b, d));
    if (gap == 0 || gap > kNearlyCoincideOfEdge * std::min(distance(a, b), distance(c, d)))
      continue;
    cracks.largest_gap_m = std::max(cracks.largest_gap_m, gap);
    cracks.corners.insert(cracks.corners.end(), {a, b, c, d});
  }
  std::sort(cracks.corners.begin(), cracks.corners.end());
  cracks.corners.erase(std::unique(cracks.corners.begin(), cracks.corners.end()),
                       cracks.corners.end());
  return cracks;
}

}  // namespace palpate::bake
