// SPDX-License-Identifier: Apache-2.0
// The nearest pairs of triangles of a region, in order.
#pragma once

#include <cstdint>

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

/// How many pairs are kept of a region. A corner near a corner is as many as thirty pairs of
/// triangles that share them; where more are as near as these, the rest is no farther than they.
inline constexpr std::uint32_t kNearPairs = 32;

/// The nearest pairs met in a search, nearest first.
struct NearPairs {
  std::uint32_t count = 0;
  Witness pairs[kNearPairs];

  /// @return where it has dropped a pair for want of room, the distance of the nearest such, else
  /// `none`. O(kNearPairs).
  float add(const Witness& pair, float none) noexcept {
    float dropped = none;
    if (count == kNearPairs) {
      const float last = pairs[count - 1].distance;
      if (!(pair.distance < last)) return pair.distance;
      dropped = last;
      --count;
    }
    std::uint32_t hole = count++;
    for (; hole > 0 && pair.distance < pairs[hole - 1].distance; --hole) {
      pairs[hole] = pairs[hole - 1];
    }
    pairs[hole] = pair;
    return dropped;
  }
};

}  // namespace palpate::regions
