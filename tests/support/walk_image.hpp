// SPDX-License-Identifier: Apache-2.0
// Follows every link that an engine may follow in a validated image and says what is wrong, written
// without a look at validate(): the oracle of its tests and of its fuzz target.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/image/view.hpp"

namespace palpate::test {
namespace walk {

template <class T>
bool holds(std::span<const T> section, std::uint64_t first, std::uint64_t count) {
  return first + count <= section.size();
}

inline bool numbers(const image::Piece& p) {
  return std::isfinite(p.centre[0]) && std::isfinite(p.centre[1]) && std::isfinite(p.centre[2]) &&
         std::isfinite(p.radius) && p.radius >= 0 && std::isfinite(p.surface_deviation) &&
         p.surface_deviation >= 0 && std::isfinite(p.hausdorff) && p.hausdorff >= 0 &&
         std::isfinite(p.resolution) && p.min_support_area > 0 &&
         std::isfinite(1.0f / p.min_support_area);
}

inline std::string vertices(const ImageView& image, const image::Piece& p) {
  if (p.hull_vertices < 1 || p.hull_vertices > p.vertices) return "hull vertices";
  if (!holds(image.vertices, p.first_vertex, p.vertices)) return "vertex run";
  for (std::uint32_t v = 0; v < p.vertices; ++v) {
    const image::Vertex& vertex = image.vertices[p.first_vertex + v];
    double squared = 0;
    double from_centre = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = static_cast<double>(vertex.position[axis]);
      squared += x * x;
      from_centre += std::pow(x - static_cast<double>(p.centre[axis]), 2);
    }
    if (!(squared <= 1.0001)) return "position";
    if (!(vertex.support_area >= p.min_support_area) || !std::isfinite(vertex.support_area)) {
      return "support area";
    }
    if (v < p.hull_vertices &&
        !(std::sqrt(from_centre) <= static_cast<double>(p.radius) * (1 + 1e-9))) {
      return "sphere";
    }
  }
  return {};
}

inline std::string faces(const ImageView& image, const image::Piece& p) {
  if (p.triangles > image.header->max_patch_triangles) return "patch capacity";
  if (p.triangles > 0 && !holds(image.triangles, p.first_triangle, p.triangles)) return "triangles";
  for (std::uint32_t i = 0; i < p.triangles; ++i) {
    const image::Triangle& t = image.triangles[p.first_triangle + i];
    for (const std::uint32_t v : t.vertices) {
      if (v >= p.vertices) return "triangle corner";
    }
    if (p.children == 0 && t.source >= image.header->source_triangles) return "source triangle";
  }
  if (p.virtual_faces > 0 && !holds(image.virtual_faces, p.first_virtual_face, p.virtual_faces)) {
    return "virtual faces";
  }
  for (std::uint32_t i = 0; i < p.virtual_faces; ++i) {
    for (const std::uint32_t v : image.virtual_faces[p.first_virtual_face + i].vertices) {
      if (v >= p.vertices) return "virtual face corner";
    }
  }
  return {};
}

/// Climbs towards +x from the last hull vertex, as a support query would.
inline std::string climb(const ImageView& image, const image::Piece& p) {
  if (p.hull_vertices > image.header->max_hull_vertices) return "hull capacity";
  if (p.hull_vertices <= image::kAdjacencyAbove) return {};
  std::uint32_t at = p.hull_vertices - 1;
  for (std::uint32_t step = 0;; ++step) {
    if (step > p.hull_vertices) return "climb does not end";
    if (!holds(image.neighbour_starts, p.first_neighbour_start, std::uint64_t{at} + 2)) {
      return "neighbour starts";
    }
    const std::uint32_t first = image.neighbour_starts[p.first_neighbour_start + at];
    const std::uint32_t last = image.neighbour_starts[p.first_neighbour_start + at + 1];
    if (first >= last || last - first > image.header->max_valence) return "neighbour list";
    std::uint32_t best = at;
    for (std::uint32_t i = first; i < last; ++i) {
      if (!holds(image.neighbours, p.first_neighbour, std::uint64_t{i} + 1)) return "neighbours";
      const std::uint32_t v = image.neighbours[p.first_neighbour + i];
      if (v >= p.hull_vertices) return "neighbour";
      if (image.vertices[p.first_vertex + v].position[0] >
          image.vertices[p.first_vertex + best].position[0]) {
        best = v;
      }
    }
    if (best == at) return {};
    at = best;
  }
}

inline std::string tree(const ImageView& image) {
  std::vector<char> seen(image.pieces.size(), 0);
  struct Entry {
    std::uint32_t piece, depth;
  };
  std::vector<Entry> stack{{0, 1}};
  std::size_t visited = 0;
  std::uint32_t deepest = 0;
  std::size_t leaves = 0;
  while (!stack.empty()) {
    const Entry e = stack.back();
    stack.pop_back();
    if (e.piece >= image.pieces.size() || seen[e.piece] != 0) return "piece seen twice";
    seen[e.piece] = 1;
    ++visited;
    deepest = e.depth > deepest ? e.depth : deepest;
    const image::Piece& p = image.pieces[e.piece];
    if (p.level >= image.levels.size()) return "level";
    if (p.children > image.header->max_children) return "children capacity";
    if ((p.children == 0) != (p.level == 0)) return "leaf level";
    leaves += p.children == 0 ? 1 : 0;
    for (std::uint32_t c = 0; c < p.children; ++c) {
      const std::uint32_t child = p.first_child + c;
      if (child >= image.pieces.size() || image.pieces[child].parent != e.piece) return "child";
      if (image.pieces[child].level >= p.level) return "child's level";
      stack.push_back({child, e.depth + 1});
    }
  }
  if (visited != image.pieces.size()) return "unreachable piece";
  if (deepest != image.header->tree_depth) return "depth";
  return leaves == image.header->leaf_pieces ? "" : "leaves";
}

}  // namespace walk

/// Empty where everything holds, else the first thing that does not.
inline std::string walk_image(const ImageView& image) {
  if (std::string fault = walk::tree(image); !fault.empty()) return fault;
  for (const image::Piece& p : image.pieces) {
    if (!walk::numbers(p)) return "piece's numbers";
    for (const auto check : {walk::vertices, walk::faces, walk::climb}) {
      if (std::string fault = check(image, p); !fault.empty()) return fault;
    }
  }
  return {};
}

}  // namespace palpate::test
