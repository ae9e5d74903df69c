// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes about the faces of a mesh, in a binary tree; faces can be hidden from the search.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

struct FaceBox {
  std::array<float, 3> low{}, high{};

  /// Around nothing yet.
  static constexpr FaceBox empty() {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  }

  [[nodiscard]] bool meets(const FaceBox& other) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (low[i] > other.high[i] || other.low[i] > high[i]) return false;
    return true;
  }
  void add(const std::array<float, 3>& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = p[i] < low[i] ? p[i] : low[i];
      high[i] = p[i] > high[i] ? p[i] : high[i];
    }
  }
};

class FaceTree {
 public:
  /// O(n log^2 n).
  explicit FaceTree(const NormalMesh& mesh);

  /// A hidden face is not visited, nor a subtree in which all are hidden. O(log n).
  void hide(std::uint32_t face) { count_hidden(face, 1); }
  void show(std::uint32_t face) { count_hidden(face, ~0u); }

  /// Visits the faces not hidden in leaves whose boxes, and all boxes above, `enter` lets pass:
  /// enter(const FaceBox&) -> bool, visit(face) -> bool, true ends the search. Returns whether a
  /// visit did.
  template <class Enter, class Visit>
  bool search(Enter enter, Visit visit) const {
    std::array<std::uint32_t, kMaxDepth> stack;
    std::size_t open = 0;
    if (!nodes_.empty()) stack[open++] = 0;
    while (open > 0) {
      const Node& node = nodes_[stack[--open]];
      if (node.hidden == node.faces || !enter(node.box)) continue;
      if (node.leaf) {
        for (std::uint32_t i = node.first; i < node.first + node.faces; ++i)
          if (!hidden_[faces_[i]] && visit(faces_[i])) return true;
        continue;
      }
      stack[open++] = node.first + 1;
      stack[open++] = node.first;
    }
    return false;
  }

 private:
  static constexpr std::size_t kMaxDepth = 64;  // halving 2^32 faces takes 32 levels
  static constexpr std::uint32_t kLeafFaces = 4;
  struct Node {
    FaceBox box;
    std::uint32_t first = 0;  // leaf: into faces_; else the first of two children
    std::uint32_t faces = 0;  // below it
    std::uint32_t hidden = 0;
    std::uint32_t parent = 0;  // the root's is itself
    bool leaf = false;
  };
  void count_hidden(std::uint32_t face, std::uint32_t by);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> faces_;
  std::vector<std::uint32_t> leaf_of_face_;
  std::vector<char> hidden_;
};

}  // namespace palpate::bake
