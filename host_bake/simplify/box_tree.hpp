// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that come and go, found by place: a loose octree (Ulrich 2000).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_bake/decompose/face_tree.hpp"

namespace palpate::bake {

/// Each box hangs on the one cell that holds its centre, at the depth where cells are at least as
/// wide as the box, so that it reaches at most half a cell beyond. Putting, moving and taking cost
/// the depth, and nothing has to be adapted while boxes grow.
class BoxTree {
 public:
  /// Boxes lie within [-2, 2] on each axis.
  explicit BoxTree(std::size_t boxes);

  /// Puts the box, or moves it there.
  void put(std::uint32_t id, const FaceBox& box);
  void take(std::uint32_t id);
  [[nodiscard]] const FaceBox& box(std::uint32_t id) const { return boxes_[id]; }

  /// visit(id) -> bool for every box that meets `query`; true ends the search. Returns whether a
  /// visit did. Nothing may be put or taken meanwhile.
  template <class Visit>
  bool search(const FaceBox& query, Visit visit) const {
    std::array<std::uint32_t, 8 * kDepth> stack;
    std::size_t open = 0;
    stack[open++] = 0;
    while (open > 0) {
      const Cell& cell = cells_[stack[--open]];
      for (std::uint32_t id = cell.first; id != kEnd; id = next_[id])
        if (boxes_[id].meets(query) && visit(id)) return true;
      for (const std::uint32_t child : cell.children)
        if (child != kEnd && cells_[child].below > 0 && cells_[child].reaches(query))
          stack[open++] = child;
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  static constexpr std::uint32_t kDepth = 16;  // cells from 4 down to 1.2e-4; smaller boxes share
  struct Cell {
    std::array<float, 3> centre{};
    float half = 2;  // of its width
    std::uint32_t parent = kEnd;
    std::uint32_t below = 0;  // boxes on it and under it
    std::uint32_t first = kEnd;
    std::array<std::uint32_t, 8> children{kEnd, kEnd, kEnd, kEnd, kEnd, kEnd, kEnd, kEnd};

    [[nodiscard]] bool reaches(const FaceBox& box) const {
      for (std::size_t i = 0; i < 3; ++i)
        if (box.low[i] > centre[i] + 2 * half || box.high[i] < centre[i] - 2 * half) return false;
      return true;
    }
  };
  [[nodiscard]] std::uint32_t cell_for(const FaceBox& box);

  std::vector<FaceBox> boxes_;
  std::vector<std::uint32_t> next_, previous_, cell_of_;
  std::vector<Cell> cells_;
};

}  // namespace palpate::bake
