// SPDX-License-Identifier: Apache-2.0
// Two bodies as the region search sees them: the boxes of their trees and the maps between them, in
// float.
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

inline Transform in_float(const Mat3d& r, Vec3d translation, double scale) noexcept {
  const auto f = [](double v) noexcept { return static_cast<float>(v); };
  return {{f(r.row0.x), f(r.row0.y), f(r.row0.z), f(r.row1.x), f(r.row1.y), f(r.row1.z),
           f(r.row2.x), f(r.row2.y), f(r.row2.z)},
          {f(translation.x), f(translation.y), f(translation.z)},
          f(scale)};
}

/// The frame of a pair whose poses are set.
inline PairFrame frame_of(const levels::PairState& pair) noexcept {
  const Mat3d& r = pair.b_in_a.rotation;
  const Vec3d t = pair.b_in_a.translation;
  const Mat3d back = transpose(r);
  PairFrame frame;
  frame.a = pair.image_a;
  frame.b = pair.image_b;
  frame.b_to_a = in_float(r, (1.0 / pair.scale_a) * t, pair.scale_b / pair.scale_a);
  frame.a_to_b = in_float(back, (1.0 / pair.scale_b) * -(back * t), pair.scale_a / pair.scale_b);
  frame.scale2_a = static_cast<float>(pair.scale_a * pair.scale_a);
  frame.scale2_b = static_cast<float>(pair.scale_b * pair.scale_b);
  return frame;
}

/// A child of a node: a box, and below it a node or a triangle. Its name is the node's index times
/// kRegionWidth plus the slot.
constexpr std::uint32_t child_name(std::uint32_t node, std::uint32_t slot) noexcept {
  return node * image::kRegionWidth + slot;
}
constexpr std::uint32_t node_of(std::uint32_t name) noexcept { return name / image::kRegionWidth; }
constexpr std::uint32_t slot_of(std::uint32_t name) noexcept { return name % image::kRegionWidth; }

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
