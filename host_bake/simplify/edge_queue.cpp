// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/edge_queue.hpp"

#include <algorithm>

namespace palpate::bake {
namespace {

bool later(const EdgeQueue::Entry& a, const EdgeQueue::Entry& b) {
  return a.key != b.key ? a.key < b.key : a.half_edge > b.half_edge;
}

}  // namespace

EdgeQueue::EdgeQueue(const Surface& surface) : surface_(surface), states_(surface.twin.size()) {}

std::uint32_t EdgeQueue::name(std::uint32_t half_edge) const {
  return std::min(half_edge, surface_.twin[half_edge]);
}

void EdgeQueue::put(std::uint32_t half_edge, float key) {
  forget(half_edge);
  const std::uint32_t h = name(half_edge);
  State& state = states_[h];
  state.key = key;
  state.queued = true;
  state.outdated = false;
  heap_.push_back({key, h, state.stamp, false});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void EdgeQueue::forget(std::uint32_t half_edge) {
  for (const std::uint32_t h : {half_edge, surface_.twin[half_edge]}) {
    if (h == kNothing) continue;
    ++states_[h].stamp;
    states_[h].queued = false;
  }
}

void EdgeQueue::touch(std::uint32_t half_edge) {
  State& state = states_[name(half_edge)];
  if (!state.queued) put(half_edge, state.key);
  state.outdated = true;
}

void EdgeQueue::clean() {
  while (!heap_.empty() && states_[heap_.front().half_edge].stamp != heap_.front().stamp) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
  }
}

float EdgeQueue::next_key() {
  clean();
  return heap_.empty() ? -1.0F : heap_.front().key;
}

EdgeQueue::Entry EdgeQueue::pop() {
  clean();
  if (heap_.empty()) return {};
  std::pop_heap(heap_.begin(), heap_.end(), later);
  Entry entry = heap_.back();
  heap_.pop_back();
  State& state = states_[entry.half_edge];
  entry.outdated = state.outdated;
  state.queued = false;
  return entry;
}

}  // namespace palpate::bake
