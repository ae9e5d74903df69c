// SPDX-License-Identifier: Apache-2.0
// Boxes of the trees by the names of children (pair_frame.hpp).
#pragma once

#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {

inline Box box_of(const image::RegionNode& node, std::uint32_t slot) noexcept {
  Box box;
  for (std::uint32_t k = 0; k < 3; ++k) {
    box.x[k] = node.axes[3 * k][slot];
    box.y[k] = node.axes[3 * k + 1][slot];
    box.z[k] = node.axes[3 * k + 2][slot];
    box.half[k] = node.half[k][slot];
  }
  box.x[3] = node.centre[0][slot];
  box.y[3] = node.centre[1][slot];
  box.z[3] = node.centre[2][slot];
  box.half[3] = 0;
  return box;
}

/// Squared half diagonal, in the image's unit.
inline float size2_of(const image::RegionNode& node, std::uint32_t slot) noexcept {
  const float x = node.half[0][slot];
  const float y = node.half[1][slot];
  const float z = node.half[2][slot];
  return x * x + y * y + z * z;
}

/// Product of half the lengths, in the image's unit.
inline float volume_of(const image::RegionNode& node, std::uint32_t slot) noexcept {
  return node.half[0][slot] * node.half[1][slot] * node.half[2][slot];
}

}  // namespace palpate::regions
