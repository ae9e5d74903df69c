// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/box_tree.hpp"

#include <algorithm>

namespace palpate::bake {

BoxTree::BoxTree(std::size_t boxes)
    : boxes_(boxes), next_(boxes, kEnd), previous_(boxes, kEnd), cell_of_(boxes, kEnd), cells_(1) {}

/// Makes the cells on the way down.
std::uint32_t BoxTree::cell_for(const FaceBox& box) {
  float width = 0;
  std::array<float, 3> middle{};
  for (std::size_t i = 0; i < 3; ++i) {
    width = std::max(width, box.high[i] - box.low[i]);
    middle[i] = (box.low[i] + box.high[i]) / 2;
  }
  std::uint32_t at = 0;
  // A little wider than the box, which makes up for the rounding of its middle.
  for (std::uint32_t depth = 1; depth < kDepth && cells_[at].half >= 1.01F * width; ++depth) {
    std::size_t octant = 0;
    Cell child;
    child.half = cells_[at].half / 2;
    child.parent = at;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool high = middle[i] > cells_[at].centre[i];
      octant |= std::size_t{high} << i;
      child.centre[i] = cells_[at].centre[i] + (high ? child.half : -child.half);
    }
    if (cells_[at].children[octant] == kEnd) {
      cells_[at].children[octant] = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(child);
    }
    at = cells_[at].children[octant];
  }
  return at;
}

void BoxTree::take(std::uint32_t id) {
  const std::uint32_t cell = cell_of_[id];
  if (cell == kEnd) return;
  if (previous_[id] != kEnd) {
    next_[previous_[id]] = next_[id];
  } else {
    cells_[cell].first = next_[id];
  }
  if (next_[id] != kEnd) previous_[next_[id]] = previous_[id];
  for (std::uint32_t c = cell; c != kEnd; c = cells_[c].parent) --cells_[c].below;
  cell_of_[id] = kEnd;
}

void BoxTree::put(std::uint32_t id, const FaceBox& box) {
  const std::uint32_t cell = cell_for(box);
  boxes_[id] = box;
  if (cell_of_[id] == cell) return;
  take(id);
  next_[id] = cells_[cell].first;
  previous_[id] = kEnd;
  if (next_[id] != kEnd) previous_[next_[id]] = id;
  cells_[cell].first = id;
  for (std::uint32_t c = cell; c != kEnd; c = cells_[c].parent) ++cells_[c].below;
  cell_of_[id] = cell;
}

}  // namespace palpate::bake
