// SPDX-License-Identifier: Apache-2.0
// What crosses in a region.
#pragma once

#include <cstdint>

#include "rt_core/regions/crossing_curve.hpp"

namespace palpate::regions {

inline constexpr std::uint32_t kMaxCrossings = 16;

/// Two pieces (level 0) whose triangles cross, and the curve in which they do.
struct CrossingPieces {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  CrossingCurve curve;
};

/// Each pair of pieces once.
struct CrossingList {
  std::uint32_t count = 0;
  CrossingPieces pieces[kMaxCrossings];
  CrossingCurve rest;  ///< of pieces for which there was no room: both ways out count alike
};

/// Adds two triangles that cross. O(kMaxCrossings)
void note_crossing(const levels::PairState& pair, std::uint32_t triangle_a,
                   std::uint32_t triangle_b, CrossingList& list) noexcept;

}  // namespace palpate::regions
