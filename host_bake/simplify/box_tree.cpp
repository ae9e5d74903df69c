// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/box_tree.hpp"

#include <algorithm>
#include <utility>

namespace palpate::bake {

BoxTree::BoxTree(std::size_t boxes) : places_(boxes), cells_(1) {}

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
    child.octant = static_cast<std::uint32_t>(octant);
    if (cells_[at].children[octant] == kEnd) {
      cells_[at].children[octant] = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(std::move(child));
    }
    at = cells_[at].children[octant];
  }
  return at;
}

/// Boxes have come to a cell, or gone from it.
void BoxTree::count(std::uint32_t cell, std::uint32_t by) {
  for (std::uint32_t c = cell; c != kEnd; c = cells_[c].parent) {
    cells_[c].below += by;
    if (cells_[c].parent == kEnd) continue;
    std::uint32_t& full = cells_[cells_[c].parent].full;
    const std::uint32_t bit = 1u << cells_[c].octant;
    full = cells_[c].below > 0 ? full | bit : full & ~bit;
  }
}

void BoxTree::take(std::uint32_t id) {
  Place& place = places_[id];
  if (place.cell == kEnd) return;
  std::vector<Entry>& entries = cells_[place.cell].entries;
  places_[entries.back().id].slot = place.slot;
  entries[place.slot] = entries.back();
  entries.pop_back();
  count(place.cell, ~0u);
  place.cell = kEnd;
}

void BoxTree::put(std::uint32_t id, const FaceBox& box) {
  const std::uint32_t cell = cell_for(box);
  Place& place = places_[id];
  std::vector<Entry>& entries = cells_[cell].entries;
  if (place.cell == cell) {
    entries[place.slot].box = box;
    return;
  }
  take(id);
  place = {cell, static_cast<std::uint32_t>(entries.size())};
  entries.push_back({box, id});
  count(cell, 1);
}

}  // namespace palpate::bake
