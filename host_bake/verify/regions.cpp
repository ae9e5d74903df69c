// SPDX-License-Identifier: GPL-3.0-or-later
// The region engine's triangles against the pieces of the original surface, and one another.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "host_bake/verify/proofs.hpp"

namespace palpate::bake {
namespace {

using TriangleCorners = std::array<PointF, 3>;

TriangleCorners corners_of(const image::RegionTriangle& t) {
  TriangleCorners c;
  for (std::size_t i = 0; i < 3; ++i) std::copy_n(t.corners + 3 * i, 3, c[i].begin());
  return c;
}

// The same corners in the same sense of rotation.
bool same_triangle(const TriangleCorners& a, const TriangleCorners& b) {
  for (std::size_t shift = 0; shift < 3; ++shift) {
    if (a[0] == b[shift] && a[1] == b[(shift + 1) % 3] && a[2] == b[(shift + 2) % 3]) return true;
  }
  return false;
}

std::string not_of_its_piece(const Evidence& evidence, const image::RegionTriangle& t) {
  const auto& points = evidence.points[t.piece];
  for (const image::Triangle& of_piece : patch(evidence, evidence.image.pieces[t.piece])) {
    if (of_piece.source != t.source) continue;
    const auto& v = of_piece.vertices;
    const bool same = same_triangle({points[v[0]], points[v[1]], points[v[2]]}, corners_of(t));
    return same ? "" : "its corners are not those in its piece";
  }
  return "its piece does not hold it";
}

// Edge i runs from corner i to i + 1; the neighbour runs through it the other way.
std::string not_across(const ImageView& image, const image::RegionTriangle& t, std::size_t i) {
  const TriangleCorners mine = corners_of(t);
  const TriangleCorners other = corners_of(image.region_triangles[t.neighbours[i]]);
  for (std::size_t k = 0; k < 3; ++k) {
    if (other[k] == mine[(i + 1) % 3] && other[(k + 1) % 3] == mine[i]) return {};
  }
  return "does not share the edge with its neighbour " + std::to_string(t.neighbours[i]);
}

template <class Check>
Proof prove_each_triangle(const std::string& invariant, const ImageView& image, Check check) {
  if (image.region_triangles.empty()) return {invariant, true, "no regions"};
  for (std::size_t i = 0; i < image.region_triangles.size(); ++i) {
    const std::string wrong = check(image.region_triangles[i]);
    if (!wrong.empty()) return {invariant, false, "triangle " + std::to_string(i) + ": " + wrong};
  }
  return {invariant, true, std::to_string(image.region_triangles.size()) + " triangles"};
}

}  // namespace

Proof prove_region_triangles(const Evidence& evidence) {
  std::vector<char> seen(evidence.image.header->source_triangles, 0);
  return prove_each_triangle("the wide tree holds every triangle of level 0 once", evidence.image,
                             [&](const image::RegionTriangle& t) {
                               if (seen[t.source]++ != 0)
                                 return std::string("its source is there twice");
                               return not_of_its_piece(evidence, t);
                             });
}

Proof prove_region_neighbours(const Evidence& evidence) {
  return prove_each_triangle("neighbours in the wide tree share an edge", evidence.image,
                             [&](const image::RegionTriangle& t) {
                               std::string wrong;
                               for (std::size_t i = 0; i < 3 && wrong.empty(); ++i) {
                                 if (t.neighbours[i] != image::kNone)
                                   wrong = not_across(evidence.image, t, i);
                               }
                               return wrong;
                             });
}

}  // namespace palpate::bake
