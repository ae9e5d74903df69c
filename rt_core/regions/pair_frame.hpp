// SPDX-License-Identifier: Apache-2.0
// Two bodies as the region search sees them: their trees and the maps between them, in float.
#pragma once

#include <cstdint>

#include "rt_core/image/view.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/regions/kernels.hpp"

namespace palpate::regions {

/// What float rounding of maps, boxes and triangle distances may take from a bound, in units of the
/// larger radius: every bound below is a bound once this is subtracted.
inline constexpr float kRounding = 1e-6f;

/// Rounded towards minus infinity far enough for float.
inline float float_below(double v) noexcept {
  return static_cast<float>(v - 1e-7 * (v < 0 ? -v : v));
}

/// Lengths are in units of the larger radius (levels::PairState) unless a name says image.
struct PairFrame {
  const ImageView* a = nullptr;
  const ImageView* b = nullptr;
  Transform a_to_b{};  ///< image coordinates to image coordinates
  Transform b_to_a{};
  float scale2_a = 1;  ///< squared units of a's squared image coordinates
  float scale2_b = 1;
};

/// The frame of a pair whose poses are set.
PairFrame frame_of(const levels::PairState& pair) noexcept;

/// A child of a node: a box, and below it a node or a triangle. Its name is the node's index times
/// kRegionWidth plus the slot.
constexpr std::uint32_t child_name(std::uint32_t node, std::uint32_t slot) noexcept {
  return node * image::kRegionWidth + slot;
}
constexpr std::uint32_t node_of(std::uint32_t name) noexcept { return name / image::kRegionWidth; }
constexpr std::uint32_t slot_of(std::uint32_t name) noexcept { return name % image::kRegionWidth; }

}  // namespace palpate::regions
