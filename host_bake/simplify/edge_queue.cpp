// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/edge_queue.hpp"

#include <algorithm>
#include <bit>

namespace palpate::bake {
namespace {

// Sign, exponent and seven bits of the mantissa: 128 buckets an octave.
constexpr int kDroppedBits = 16;
constexpr std::size_t kBuckets = std::size_t{1} << (31 - kDroppedBits);

std::size_t bucket_of(float key) { return std::bit_cast<std::uint32_t>(key) >> kDroppedBits; }

bool later(const EdgeQueue::Entry& a, const EdgeQueue::Entry& b) {
  return a.key != b.key ? a.key < b.key : a.half_edge > b.half_edge;
}

}  // namespace

EdgeQueue::EdgeQueue(const Surface& surface)
    : surface_(surface), states_(surface.twin.size()), buckets_(kBuckets) {}

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
  const std::size_t b = bucket_of(key);
  buckets_[b].push_back({key, h, state.stamp, false});
  std::push_heap(buckets_[b].begin(), buckets_[b].end(), later);
  last_ = std::max(last_, b);
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

std::vector<EdgeQueue::Entry>& EdgeQueue::front() {
  for (;; --last_) {
    std::vector<Entry>& heap = buckets_[last_];
    while (!heap.empty() && states_[heap.front().half_edge].stamp != heap.front().stamp) {
      std::pop_heap(heap.begin(), heap.end(), later);
      heap.pop_back();
    }
    if (!heap.empty() || last_ == 0) return heap;
  }
}

float EdgeQueue::next_key() {
  const std::vector<Entry>& heap = front();
  return heap.empty() ? -1.0F : heap.front().key;
}

EdgeQueue::Entry EdgeQueue::pop() {
  std::vector<Entry>& heap = front();
  if (heap.empty()) return {};
  std::pop_heap(heap.begin(), heap.end(), later);
  Entry entry = heap.back();
  heap.pop_back();
  State& state = states_[entry.half_edge];
  entry.outdated = state.outdated;
  state.queued = false;
  return entry;
}

}  // namespace palpate::bake
