// SPDX-License-Identifier: Apache-2.0
// Boxes of the trees by the names of children (pair_frame.hpp).
#pragma once

#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {

/// Four floats in one store: whoever reads them as a vector need not wait for four.
inline void put(float a, float b, float c, float d, float (&to)[4]) noexcept {
  using Four = float __attribute__((vector_size(4 * sizeof(float))));
  const Four row = {a, b, c, d};
  __builtin_memcpy(to, &row, sizeof row);
}

inline Box box_of(const image::RegionNode& node, std::uint32_t slot) noexcept {
  const auto& axes = node.axes;
  const auto& centre = node.centre;
  const auto& half = node.half;
  Box box;
  put(axes[0][slot], axes[3][slot], axes[6][slot], centre[0][slot], box.x);
  put(axes[1][slot], axes[4][slot], axes[7][slot], centre[1][slot], box.y);
  put(axes[2][slot], axes[5][slot], axes[8][slot], centre[2][slot], box.z);
  put(half[0][slot], half[1][slot], half[2][slot], 0, box.half);
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
