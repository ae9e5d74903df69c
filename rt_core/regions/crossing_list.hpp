// SPDX-License-Identifier: Apache-2.0
// What crosses in a region.
#pragma once

#include <cstdint>

#include "rt_core/regions/crossing_curve.hpp"

namespace palpate::regions {

inline constexpr std::uint32_t kMaxCrossings = 16;

/// Pairs of pieces (level 0) whose triangles cross, each once, and the curve in which they do.
struct CrossingList {
  std::uint32_t count = 0;
  std::uint32_t piece_a[kMaxCrossings] = {};
  std::uint32_t piece_b[kMaxCrossings] = {};
  CrossingCurve curve;
};

/// Adds two triangles that cross. Pieces for which there is no room are left out, their segment is
/// not. O(kMaxCrossings)
void note_crossing(const levels::PairState& pair, std::uint32_t triangle_a,
                   std::uint32_t triangle_b, CrossingList& list) noexcept;

}  // namespace palpate::regions
