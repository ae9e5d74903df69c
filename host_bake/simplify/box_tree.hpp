// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that come and go, found by place: a loose octree (Ulrich 2000).
#pragma once

#include <array>
#include <bit>
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
  [[nodiscard]] const FaceBox& box(std::uint32_t id) const {
    return cells_[places_[id].cell].entries[places_[id].slot].box;
  }

  /// visit(id) -> bool for every box that meets `query`; true ends the search. Returns whether a
  /// visit did. Nothing may be put or taken meanwhile.
  template <class Visit>
  bool search(const FaceBox& query, Visit visit) const {
    std::array<std::uint32_t, 8 * kDepth> stack;
    std::size_t open = 0;
    stack[open++] = 0;
    while (open > 0) {
      const Cell& cell = cells_[stack[--open]];
      for (const Entry& entry : cell.entries)
        if (entry.box.meets(query) && visit(entry.id)) return true;
      for (std::uint32_t octants = cell.full & cell.reached_by(query); octants != 0;
           octants &= octants - 1)
        stack[open++] = cell.children[static_cast<std::size_t>(std::countr_zero(octants))];
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  static constexpr std::uint32_t kDepth = 16;  // cells from 4 down to 1.2e-4; smaller boxes share
  struct Entry {
    FaceBox box;
    std::uint32_t id;
  };
  struct Cell {
    std::vector<Entry> entries;
    std::array<float, 3> centre{};
    float half = 2;  // of its width
    std::uint32_t parent = kEnd;
    std::uint32_t octant = 0;  // of the parent's children it is
    std::uint32_t below = 0;   // boxes on it and under it
    std::uint32_t full = 0;    // a bit for each child that has boxes
    std::array<std::uint32_t, 8> children{kEnd, kEnd, kEnd, kEnd, kEnd, kEnd, kEnd, kEnd};

    /// A bit for each octant that boxes of its child can stand out to. Told without a look at the
    /// children, most of which are far away in memory.
    [[nodiscard]] std::uint32_t reached_by(const FaceBox& query) const {
      constexpr std::array<std::uint32_t, 3> kHigh = {0xaa, 0xcc, 0xf0};  // octants, by axis
      std::uint32_t octants = 0xff;
      for (std::size_t i = 0; i < 3; ++i) {
        const float low = query.low[i] - centre[i], high = query.high[i] - centre[i];
        std::uint32_t reached = 0;
        if (low <= 0.5F * half && high >= -1.5F * half) reached = ~kHigh[i];
        if (low <= 1.5F * half && high >= -0.5F * half) reached |= kHigh[i];
        octants &= reached;
      }
      return octants;
    }
  };
  struct Place {
    std::uint32_t cell = kEnd;
    std::uint32_t slot = 0;  // of the cell's entries
  };
  [[nodiscard]] std::uint32_t cell_for(const FaceBox& box);
  void count(std::uint32_t cell, std::uint32_t by);

  std::vector<Place> places_;
  std::vector<Cell> cells_;
};

}  // namespace palpate::bake
