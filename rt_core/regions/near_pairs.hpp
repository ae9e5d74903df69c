// SPDX-License-Identifier: Apache-2.0
// The nearest pairs of triangles of a region, in order.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/queue.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::regions {

/// More than any distance, in units, with a square that is still a float.
inline constexpr float kFarthest = 1e18f;

/// A pair of triangles and its distance.
struct Witness {
  std::uint32_t a = image::kNone;  ///< into a's region_triangles
  std::uint32_t b = image::kNone;
  float distance = 0;  ///< in units; meaningless without triangles
  [[nodiscard]] bool known() const noexcept { return a != image::kNone; }
  [[nodiscard]] bool nearer_than(float limit) const noexcept { return known() && distance < limit; }
  [[nodiscard]] bool crosses() const noexcept { return known() && distance <= 0; }
  [[nodiscard]] bool same_pair(const Witness& w) const noexcept { return a == w.a && b == w.b; }
};

/// How many pairs are kept of a region, at most. A corner near a corner is as many as thirty pairs
/// of triangles that share them; where more are as near as these, the rest is no farther than they.
inline constexpr std::uint32_t kNearPairs = 128;

/// The nearest pairs met in a search, in no order until they are sorted.
struct NearPairs {
  std::uint32_t count = 0;
  std::uint32_t room = kNearPairs;  ///< 1 to kNearPairs
  Witness pairs[kNearPairs];

  /// Those of another; O(n).
  void take(const NearPairs& other) noexcept {
    count = other.count;
    room = other.room;
    for (std::uint32_t k = 0; k < count; ++k) pairs[k] = other.pairs[k];
  }

  /// @return where it has dropped a pair for want of room, the distance of the nearest such, else
  /// `none`. O(1), and O(log room) where there is none; O(room) once.
  float add(const Witness& pair, float none) noexcept {
    MinQueue<Witness, Farther> farthest_first{std::span<Witness>(pairs, room)};
    if (count < room) {
      pairs[count++] = pair;
      if (count == room) farthest_first.fill();
      return none;
    }
    farthest_first.adopt();
    const float dropped = farthest_first.top().distance;
    if (!(pair.distance < dropped)) return pair.distance;
    farthest_first.pop();
    farthest_first.push(pair);
    return dropped;
  }

  /// Nearest first. O(n log n).
  void sort() noexcept {
    MinQueue<Witness, Farther> farthest_first{std::span<Witness>(pairs, count)};
    farthest_first.fill();
    for (std::uint32_t left = count; left > 0; --left) {
      const Witness farthest = farthest_first.top();
      farthest_first.pop();
      pairs[left - 1] = farthest;
    }
  }

 private:
  struct Farther {
    bool operator()(const Witness& a, const Witness& b) const noexcept {
      return a.distance > b.distance;
    }
  };
};

}  // namespace palpate::regions
