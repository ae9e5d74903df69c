// SPDX-License-Identifier: GPL-3.0-or-later
// Edges in the order of resolution, highest first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {

/// Holds each edge at most once, under either of its half-edges. An entry may be outdated: what it
/// was computed from has changed since, and it is computed anew when it comes up. Keys are not
/// negative.
///
/// Keys are sorted into buckets by their leading bits, and within a bucket by a heap that fits the
/// cache.
class EdgeQueue {
 public:
  explicit EdgeQueue(const Surface& surface);

  /// Puts an edge, or gives it a new key.
  void put(std::uint32_t half_edge, float key);
  /// Marks an edge outdated; puts it with its last key where it is not in the queue.
  void touch(std::uint32_t half_edge);
  /// The edge will not come up any more; before its half-edges change.
  void forget(std::uint32_t half_edge);

  struct Entry {
    float key = 0;
    std::uint32_t half_edge = kNothing;
    std::uint32_t stamp = 0;
    bool outdated = false;
  };
  /// Takes the first edge; half_edge is kNothing where none is left.
  Entry pop();
  /// The next key, or less than 0 where none is left.
  float next_key();

 private:
  struct State {
    float key = 0;
    std::uint32_t stamp = 0;
    bool queued = false, outdated = false;
  };
  [[nodiscard]] std::uint32_t name(std::uint32_t half_edge) const;
  /// The bucket whose front is the first edge; the buckets are empty where that is.
  std::vector<Entry>& front();

  const Surface& surface_;
  std::vector<State> states_;  // by half-edge; both of an edge carry the stamp
  std::vector<std::vector<Entry>> buckets_;
  std::size_t last_ = 0;  // no bucket beyond it holds an entry
};

}  // namespace palpate::bake
