// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/box_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate::bake {
namespace {

constexpr std::uint64_t kNoKey = ~std::uint64_t{0};
constexpr std::int32_t kOffset = 1 << 19;  // cells are at most 2^19 from the origin

}  // namespace

BoxGrid::BoxGrid(std::size_t boxes)
    : boxes_(boxes),
      next_(boxes, kEnd),
      previous_(boxes, kEnd),
      key_of_(boxes, kNoKey),
      slots_(std::bit_ceil(2 * boxes + 16)) {}

std::int32_t BoxGrid::cell_at(float x, float size) {
  const float cell = std::floor(x / size);
  return static_cast<std::int32_t>(std::clamp(cell, -524287.0F, 524287.0F));
}

std::uint64_t BoxGrid::key(std::uint32_t level, std::int32_t x, std::int32_t y, std::int32_t z) {
  const auto part = [](std::int32_t c) { return static_cast<std::uint64_t>(c + kOffset); };
  return part(x) | part(y) << 20 | part(z) << 40 | std::uint64_t{level} << 60;
}

std::size_t BoxGrid::slot_of(std::uint64_t key) const {
  std::uint64_t hash = key * 0x9e3779b97f4a7c15u;
  hash ^= hash >> 32;
  std::size_t slot = hash & (slots_.size() - 1);
  while (slots_[slot].key != key && slots_[slot].key != kNoKey)
    slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

std::uint32_t BoxGrid::first_in(std::uint64_t key) const { return slots_[slot_of(key)].first; }

void BoxGrid::grow() {
  std::vector<Slot> old = std::move(slots_);
  const auto full = static_cast<std::size_t>(
      std::count_if(old.begin(), old.end(), [](const Slot& s) { return s.first != kEnd; }));
  slots_.assign(std::bit_ceil(4 * full + 16), Slot{});
  used_ = full;
  for (const Slot& slot : old)
    if (slot.first != kEnd) slots_[slot_of(slot.key)] = slot;
}

void BoxGrid::take(std::uint32_t id) {
  if (key_of_[id] == kNoKey) return;
  --in_level_[key_of_[id] >> 60];
  if (previous_[id] != kEnd) {
    next_[previous_[id]] = next_[id];
  } else {
    slots_[slot_of(key_of_[id])].first = next_[id];
  }
  if (next_[id] != kEnd) previous_[next_[id]] = previous_[id];
  key_of_[id] = kNoKey;
}

void BoxGrid::put(std::uint32_t id, const FaceBox& box) {
  float width = 0;
  std::array<float, 3> centre;
  for (std::size_t i = 0; i < 3; ++i) {
    width = std::max(width, box.high[i] - box.low[i]);
    centre[i] = (box.low[i] + box.high[i]) / 2;
  }
  std::uint32_t level = 0;
  while (level + 1 < kLevels && cell_size(level + 1) >= 1.01F * width) ++level;
  const float size = cell_size(level);
  const std::uint64_t at =
      key(level, cell_at(centre[0], size), cell_at(centre[1], size), cell_at(centre[2], size));
  boxes_[id] = box;
  if (key_of_[id] == at) return;
  take(id);
  if (2 * (used_ + 1) > slots_.size()) grow();
  Slot& slot = slots_[slot_of(at)];
  if (slot.key == kNoKey) {
    slot.key = at;
    ++used_;
  }
  next_[id] = slot.first;
  previous_[id] = kEnd;
  if (slot.first != kEnd) previous_[slot.first] = id;
  slot.first = id;
  key_of_[id] = at;
  ++in_level_[level];
}

}  // namespace palpate::bake
