// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that come and go, found by place: a hashed grid for every power of two of the box size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_bake/decompose/face_tree.hpp"

namespace palpate::bake {

/// Each box is kept in the one cell that holds its centre, in the grid whose cells are at least as
/// wide as the box; so putting, moving and taking are O(1) and nothing has to be adapted while
/// boxes grow. A query looks at the cells within half a cell of it, in every grid that is not
/// empty.
class BoxGrid {
 public:
  explicit BoxGrid(std::size_t boxes);

  /// Puts the box, or moves it there.
  void put(std::uint32_t id, const FaceBox& box);
  void take(std::uint32_t id);
  [[nodiscard]] const FaceBox& box(std::uint32_t id) const { return boxes_[id]; }

  /// visit(id) -> bool for every box that meets `query`; true ends the search. Returns whether a
  /// visit did. Nothing may be put or taken meanwhile.
  template <class Visit>
  bool search(const FaceBox& query, Visit visit) const {
    for (std::uint32_t level = 0; level < kLevels; ++level) {
      if (in_level_[level] == 0) continue;
      const float size = cell_size(level);
      std::array<std::int32_t, 3> low, high;
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = cell_at(query.low[i] - size / 2, size);
        high[i] = cell_at(query.high[i] + size / 2, size);
      }
      for (std::int32_t x = low[0]; x <= high[0]; ++x)
        for (std::int32_t y = low[1]; y <= high[1]; ++y)
          for (std::int32_t z = low[2]; z <= high[2]; ++z)
            for (std::uint32_t id = first_in(key(level, x, y, z)); id != kEnd; id = next_[id])
              if (boxes_[id].meets(query) && visit(id)) return true;
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  static constexpr std::uint32_t kLevels = 16;  // cells from 4 down to 1.2e-4; smaller boxes share the last
  struct Slot {
    std::uint64_t key = ~std::uint64_t{0};
    std::uint32_t first = kEnd;
  };
  static float cell_size(std::uint32_t level) { return 4.0F / static_cast<float>(1U << level); }
  static std::int32_t cell_at(float x, float size);
  static std::uint64_t key(std::uint32_t level, std::int32_t x, std::int32_t y, std::int32_t z);
  [[nodiscard]] std::uint32_t first_in(std::uint64_t key) const;
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const;
  void grow();

  std::vector<FaceBox> boxes_;
  std::vector<std::uint32_t> next_, previous_;
  std::vector<std::uint64_t> key_of_;
  std::vector<Slot> slots_;  // open addressing; emptied cells stay until the next grow()
  std::size_t used_ = 0;
  std::array<std::uint32_t, kLevels> in_level_{};
};

}  // namespace palpate::bake
