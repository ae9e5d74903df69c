// SPDX-License-Identifier: Apache-2.0
// One box against the boxes of a node. Private to the kernels.
#pragma once

#include <limits>

#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/simd.hpp"

namespace palpate::regions {
namespace {

constexpr int kWidth = static_cast<int>(kBatch);
constexpr float kFar = std::numeric_limits<float>::max();

/// Column i of a box (an axis or the centre), turned. Scalar on purpose: the columns have just been
/// written one float at a time, and reading them as vectors would wait for the stores.
PALPATE_LANES void turn_column(const Box& from, const Transform& map, int i, Box& to) noexcept {
  const float* r = map.rotation;
  to.x[i] = r[0] * from.x[i] + r[1] * from.y[i] + r[2] * from.z[i];
  to.y[i] = r[3] * from.x[i] + r[4] * from.y[i] + r[5] * from.z[i];
  to.z[i] = r[6] * from.x[i] + r[7] * from.y[i] + r[8] * from.z[i];
}

/// A box in the coordinates of the node.
PALPATE_LANES Box mapped(const Box& box, const Transform& map) noexcept {
  Box out;
  turn_column(box, map, 0, out);
  turn_column(box, map, 1, out);
  turn_column(box, map, 2, out);
  turn_column(box, map, 3, out);
  out.x[3] = map.scale * out.x[3] + map.translation[0];
  out.y[3] = map.scale * out.y[3] + map.translation[1];
  out.z[3] = map.scale * out.z[3] + map.translation[2];
  out.half[0] = map.scale * box.half[0];
  out.half[1] = map.scale * box.half[1];
  out.half[2] = map.scale * box.half[2];
  return out;
}

/// Gap between two intervals whose centres are `between` apart, squared; 0 where they overlap.
PALPATE_LANES Floats gap_squared(Floats between, Floats half_a, Floats half_b) noexcept {
  const Floats gap = most(magnitude(between) - half_a - half_b, Floats{});
  return gap * gap;
}

/// Bound of sixteen boxes, a part of them at a time, and how far apart the centres are.
struct BoxLanes {
  Floats squared;
  Floats centres2;
};

PALPATE_LANES BoxLanes box_lanes(const Box& box, const image::RegionNode& node, int lane) noexcept {
  const Vectors axis[3] = {
      {load(node.axes[0] + lane), load(node.axes[1] + lane), load(node.axes[2] + lane)},
      {load(node.axes[3] + lane), load(node.axes[4] + lane), load(node.axes[5] + lane)},
      {load(node.axes[6] + lane), load(node.axes[7] + lane), load(node.axes[8] + lane)}};
  const Floats half[3] = {load(node.half[0] + lane), load(node.half[1] + lane),
                          load(node.half[2] + lane)};
  const Vectors apart = {box.x[3] - load(node.centre[0] + lane),
                         box.y[3] - load(node.centre[1] + lane),
                         box.z[3] - load(node.centre[2] + lane)};
  Floats cosine[3][3];  // of the node's axis and the single box's, sizes only
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      cosine[i][k] = magnitude(axis[i].x * box.x[k] + axis[i].y * box.y[k] + axis[i].z * box.z[k]);
    }
  }
  const auto along_box = [&](int k) {
    const Floats between = apart.x * box.x[k] + apart.y * box.y[k] + apart.z * box.z[k];
    const Floats of_node = cosine[0][k] * half[0] + cosine[1][k] * half[1] + cosine[2][k] * half[2];
    return gap_squared(between, of_node, all(box.half[k]));
  };
  const auto along_node = [&](int i) {
    const Floats of_box =
        cosine[i][0] * box.half[0] + cosine[i][1] * box.half[1] + cosine[i][2] * box.half[2];
    return gap_squared(dot(axis[i], apart), of_box, half[i]);
  };
  return {most(along_box(0) + along_box(1) + along_box(2),
               along_node(0) + along_node(1) + along_node(2)),
          dot(apart, apart)};
}

/// Larger for what is farther, boxes that overlap before all others and among themselves by their
/// centres. Floats of one sign compare as integers do; the last bits are the lane's, so that no two
/// are equal.
PALPATE_LANES Ints key_of(const BoxLanes& found, int lane) noexcept {
  constexpr std::int32_t kInfinity = 0x7f800000;
  constexpr auto kLast = static_cast<std::int32_t>(kBatch) - 1;
  const Ints apart = as_bits(found.squared);
  const Ints overlap = as_bits(found.centres2) - kInfinity;
  return ((found.squared > Floats{} ? apart : overlap) & ~kLast) | (kLast - lane - counting());
}

std::uint32_t test_boxes(const Box& box, const Transform& to_node, const image::RegionNode& node,
                         float unit2, float below, BoxTest& out) noexcept {
  const Box here = mapped(box, to_node);
  alignas(64) std::int32_t keys[kBatch];
  std::uint32_t near = 0;
  for (int lane = 0; lane < kWidth; lane += kLanes) {
    BoxLanes found = box_lanes(here, node, lane);
    found.squared = found.squared * all(unit2);
    const Ints is_near = found.squared < all(below);
    store(found.squared, out.squared + lane);
    store(least(is_near ? all(kFar) : found.squared, load(out.passed + lane)), out.passed + lane);
    store(key_of(found, lane), keys + lane);
    near |= bits(is_near) << lane;
  }
  near &= (1u << node.children) - 1u;
  for (int lane = 0; lane < kWidth; lane += kLanes) {
    const Ints own = load(keys + lane);
    Ints farther = {};
    for (std::uint32_t left = near; left != 0; left &= left - 1) {
      farther += ones(all(keys[__builtin_ctz(left)]) > own);
    }
    store(farther, out.place + lane);
  }
  return near;
}

}  // namespace
}  // namespace palpate::regions
