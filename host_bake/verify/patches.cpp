// SPDX-License-Identifier: GPL-3.0-or-later
// Each patch against its hull: constraints 1 and 2 of Sec. 4.3, and what virtual faces have to
// cover.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "host_bake/metrics/exact.hpp"
#include "host_bake/metrics/vector.hpp"
#include "host_bake/pack/adjacency.hpp"
#include "host_bake/pack/patch_normal.hpp"
#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

constexpr double kCoverTolerance = 1e-9;
constexpr double kNormalTolerance = 1e-6;

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

using CornerNumbers = std::uint32_t[3];

// Finds vertices of a piece above planes through three of its vertices.
class Above {
 public:
  Above(const Evidence& evidence, std::uint32_t index)
      : points_(evidence.points[index]),
        hull_vertices_(evidence.image.pieces[index].hull_vertices),
        all_(points_.size()) {
    std::iota(all_.begin(), all_.end(), 0u);
    if (all_.size() > image::kAdjacencyAbove)
      joined_ = adjacency(evidence.hulls[index].faces, hull_vertices_);
  }

  [[nodiscard]] bool any(const CornerNumbers& v) const {
    const auto suspects = suspects_of(v);
    return std::any_of(suspects.begin(), suspects.end(), [&](std::uint32_t s) {
      return side_of_plane(points_[v[0]], points_[v[1]], points_[v[2]], points_[s]) > 0;
    });
  }

 private:
  // Where a corner is a hull vertex its neighbours tell: a hull that is not above a plane next to
  // one of its points on the plane is nowhere above it. Otherwise, and on small hulls, all vertices
  // are asked.
  [[nodiscard]] std::span<const std::uint32_t> suspects_of(const CornerNumbers& v) const {
    for (const std::uint32_t corner : v) {
      if (corner >= hull_vertices_ || joined_.starts.empty()) continue;
      const std::uint32_t start = joined_.starts[corner], end = joined_.starts[corner + 1];
      if (end > start) return std::span(joined_.neighbours).subspan(start, end - start);
    }
    return all_;
  }

  const std::vector<PointF>& points_;
  std::uint32_t hull_vertices_;
  std::vector<std::uint32_t> all_;
  Adjacency joined_;
};

std::string visible_vertex(const Evidence& evidence, std::uint32_t index) {
  const auto triangles = patch(evidence, evidence.image.pieces[index]);
  if (triangles.empty()) return {};
  const Above above(evidence, index);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (above.any(triangles[t].vertices)) return "a vertex is above triangle " + std::to_string(t);
  }
  return {};
}

double area(const std::vector<PointF>& points, const CornerNumbers& v) {
  const Vec3d a = vec(points[v[0]]);
  return norm(cross(vec(points[v[1]]) - a, vec(points[v[2]]) - a)) / 2;
}

double hull_area(const std::vector<PointF>& points, const HullMesh& hull) {
  double sum = 0;
  for (const auto& f : hull.faces) sum += area(points, {f[0], f[1], f[2]});
  return sum;
}

// Of all triangles of the hull, each edge once.
double edge_length(const std::vector<PointF>& points, const HullMesh& hull) {
  double sum = 0;
  for (const auto& f : hull.faces) {
    for (std::size_t i = 0; i < 3; ++i)
      sum += norm(vec(points[f[i]]) - vec(points[f[(i + 1) % 3]])) / 2;
  }
  return sum;
}

std::span<const image::VirtualFace> virtual_faces(const ImageView& image,
                                                  const image::Piece& piece) {
  if (piece.virtual_faces == 0) return {};
  return image.virtual_faces.subspan(piece.first_virtual_face, piece.virtual_faces);
}

// That the patch's own triangles are on the hull's surface is prove_no_vertex_visible().
std::string uncovered(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  const HullMesh& hull = evidence.hulls[index];
  if (piece.triangles == 0 || hull.dimension < 3) return {};
  const std::vector<PointF>& points = evidence.points[index];
  double covered = 0;
  for (const image::Triangle& t : patch(evidence, piece)) covered += area(points, t.vertices);
  const Above above(evidence, index);
  for (const image::VirtualFace& f : virtual_faces(evidence.image, piece)) {
    if (above.any(f.vertices)) return "a virtual face is not on the hull";
    covered += area(points, f.vertices);
  }
  const double whole = hull_area(points, hull);
  const double bent = kIntrusionTolerance * edge_length(points, hull);
  if (covered >= whole * (1 - kCoverTolerance) - bent) return {};
  char left[48];
  std::snprintf(left, sizeof left, "%.3g of the hull is uncovered", 1 - covered / whole);
  return left;
}

std::string wrong_normal(const Evidence& evidence, std::uint32_t index) {
  const image::Piece& piece = evidence.image.pieces[index];
  const auto& n = piece.patch_normal;
  const bool has_side =
      (piece.flags & static_cast<std::uint32_t>(image::PieceFlag::back_open)) == 0;
  if (!has_side) return {};
  const PatchNormal expected = patch_normal(evidence.points[index], patch(evidence, piece));
  double off = std::abs(static_cast<double>(piece.patch_cosine) -
                        static_cast<double>(expected.least_cosine));
  for (std::size_t i = 0; i < 3; ++i) {
    off =
        std::max(off, std::abs(static_cast<double>(n[i]) - static_cast<double>(expected.mean[i])));
  }
  if (off <= kNormalTolerance) return {};
  return "the normal or its cosine is off by " + std::to_string(off);
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

Proof prove_patch_normals(const Evidence& evidence) {
  return prove_each("patch normals are those of the triangles", evidence.hulls.size(),
                    [&](std::uint32_t i) { return wrong_normal(evidence, i); });
}

Proof prove_hulls_covered(const Evidence& evidence) {
  return prove_each("patch and virtual faces cover the hull", evidence.hulls.size(),
                    [&](std::uint32_t i) { return uncovered(evidence, i); });
}

}  // namespace palpate::bake
