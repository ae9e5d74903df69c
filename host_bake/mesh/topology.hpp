// SPDX-License-Identifier: GPL-3.0-or-later
// How the faces of a triangle soup hang together. Precondition throughout: indices in range. A face
// that repeats a vertex has no sides and belongs to no component.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// One side of a face, as part of an undirected edge.
struct Side {
  std::uint32_t low = 0, high = 0;  ///< the edge's vertices, low < high
  std::uint32_t face = 0;
  bool forward = false;  ///< the face runs from low to high
};

inline constexpr std::uint32_t kNoComponent = 0xffffffff;

inline bool repeats_vertex(const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; }

/// All sides, those of one edge side by side, edges ascending, faces ascending within. O(n log n).
std::vector<Side> sorted_sides(const std::vector<Face>& faces);

/// Calls visit(span of the sides of one edge) for every edge of sorted_sides().
template <typename Visit>
void for_each_edge(std::span<const Side> sides, Visit visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low &&
           sides[end].high == sides[begin].high) {
      ++end;
    }
    visit(sides.subspan(begin, end - begin));
  }
}

/// Union-find; the smallest member names the set, so that numbering does not depend on the order of
/// the joins.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t x) {
    for (; parent_[x] != x; x = parent_[x]) parent_[x] = parent_[parent_[x]];
    return x;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[a < b ? b : a] = a < b ? a : b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Position (0, 1, 2) of a vertex in a face that has it.
inline std::uint32_t corner_of(const Face& face, std::uint32_t vertex) {
  return face[0] == vertex ? 0U : face[1] == vertex ? 1U : 2U;
}

/// Joins the corners (3 face + position) of two faces at both ends of the edge they share.
void join_corners(Sets& corners, const std::vector<Face>& faces, const Side& a, const Side& b);

/// Faces joined by edges, numbered by their first face.
struct Components {
  std::vector<std::uint32_t> of_face;  ///< kNoComponent for a face that repeats a vertex
  std::vector<char> closed;            ///< of each component: no edge of one face only
};
Components components_of(const std::vector<Face>& faces, std::span<const Side> sides);

}  // namespace palpate::bake
