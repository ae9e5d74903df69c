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

/// One coordinate of the axes and of the centre of a box, turned.
PALPATE_LANES void turn(const Box& from, const float* row, float (&to)[4]) noexcept {
#if PALPATE_VECTORS
  store(row[0] * four(from.x) + row[1] * four(from.y) + row[2] * four(from.z), to);
#else
  for (int i = 0; i < 4; ++i) {
    to[i] = row[0] * from.x[i] + row[1] * from.y[i] + row[2] * from.z[i];
  }
#endif
}

/// A box in the coordinates of the node, half way along a course.
PALPATE_LANES Box mapped(const Box& box, const Transform& map, Vec3f half) noexcept {
  Box out;
  turn(box, map.rotation, out.x);
  turn(box, map.rotation + 3, out.y);
  turn(box, map.rotation + 6, out.z);
  out.x[3] = map.scale * out.x[3] + map.translation[0] + half.x;
  out.y[3] = map.scale * out.y[3] + map.translation[1] + half.y;
  out.z[3] = map.scale * out.z[3] + map.translation[2] + half.z;
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

/// From the centres of sixteen boxes, a part of them at a time, to that of the box.
PALPATE_LANES Vectors centres_apart(const Box& box, const image::RegionNode& node,
                                    int lane) noexcept {
  return {box.x[3] - load(node.centre[0] + lane), box.y[3] - load(node.centre[1] + lane),
          box.z[3] - load(node.centre[2] + lane)};
}

/// Bounds of sixteen boxes, a part of them at a time, squared.
/// @param to_end  from the box, which is half way, to the end of its course
PALPATE_LANES Floats box_lanes(const Box& box, Vec3f to_end, const image::RegionNode& node,
                               int lane) noexcept {
  const Vectors axis[3] = {
      {load(node.axes[0] + lane), load(node.axes[1] + lane), load(node.axes[2] + lane)},
      {load(node.axes[3] + lane), load(node.axes[4] + lane), load(node.axes[5] + lane)},
      {load(node.axes[6] + lane), load(node.axes[7] + lane), load(node.axes[8] + lane)}};
  const Floats half[3] = {load(node.half[0] + lane), load(node.half[1] + lane),
                          load(node.half[2] + lane)};
  const Vectors apart = centres_apart(box, node, lane);
  Floats cosine[3][3];  // of the node's axis and the single box's, sizes only
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      cosine[i][k] = magnitude(axis[i].x * box.x[k] + axis[i].y * box.y[k] + axis[i].z * box.z[k]);
    }
  }
  const auto along_box = [&](int k) {
    const Floats between = apart.x * box.x[k] + apart.y * box.y[k] + apart.z * box.z[k];
    const Floats of_node = cosine[0][k] * half[0] + cosine[1][k] * half[1] + cosine[2][k] * half[2];
    const float along = to_end.x * box.x[k] + to_end.y * box.y[k] + to_end.z * box.z[k];
    return gap_squared(between, of_node, all(box.half[k] + __builtin_fabsf(along)));
  };
  const auto along_node = [&](int i) {
    const Floats of_box =
        cosine[i][0] * box.half[0] + cosine[i][1] * box.half[1] + cosine[i][2] * box.half[2];
    const Floats along =
        magnitude(axis[i].x * to_end.x + axis[i].y * to_end.y + axis[i].z * to_end.z);
    return gap_squared(dot(axis[i], apart), of_box + along, half[i]);
  };
  return most(along_box(0) + along_box(1) + along_box(2),
              along_node(0) + along_node(1) + along_node(2));
}

/// Larger for what is farther, boxes that overlap before all others and among themselves by their
/// centres. Floats of one sign compare as integers do; the last bits are the lane's, so that no two
/// are equal.
PALPATE_LANES Ints key_of(Floats squared, Vectors centres, int lane) noexcept {
  constexpr std::int32_t kInfinity = 0x7f800000;
  constexpr auto kLast = static_cast<std::int32_t>(kBatch) - 1;
  const Ints apart = as_bits(squared);
  const Ints overlap = as_bits(dot(centres, centres)) - kInfinity;
  return ((squared > Floats{} ? apart : overlap) & ~kLast) | (kLast - lane - counting());
}

std::uint32_t test_boxes(const Box& box, const Transform& to_node, Vec3f course,
                         const image::RegionNode& node, float unit2, float below, Order order,
                         BoxTest& out) noexcept {
  const Vec3f half = 0.5f * course;
  const Box here = mapped(box, to_node, half);
  std::uint32_t near = 0;
  for (int lane = 0; lane < kWidth; lane += kLanes) {
    const Floats squared = box_lanes(here, half, node, lane) * all(unit2);
    const Ints is_near = squared < all(below);
    store(squared, out.squared + lane);
    store(least(is_near ? all(kFar) : squared, load(out.passed + lane)), out.passed + lane);
    near |= bits(is_near) << lane;
  }
  near &= (1u << node.children) - 1u;
  if (order == Order::any || near == 0) return near;  // most: no order to find
  if ((near & (near - 1)) == 0) {
    out.place[__builtin_ctz(near)] = 0;
    return near;
  }
  alignas(64) std::int32_t keys[kBatch];
  for (int lane = 0; lane < kWidth; lane += kLanes) {
    store(key_of(load(out.squared + lane), centres_apart(here, node, lane), lane), keys + lane);
  }
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

/// A point against the boxes of a node.
std::uint32_t point_boxes(Vec3f point, const image::RegionNode& node, float below,
                          float (&out_squared)[kBatch]) noexcept {
  std::uint32_t near = 0;
  for (int lane = 0; lane < kWidth; lane += kLanes) {
    const Vectors apart = {point.x - load(node.centre[0] + lane),
                           point.y - load(node.centre[1] + lane),
                           point.z - load(node.centre[2] + lane)};
    Floats squared{};
    for (int k = 0; k < 3; ++k) {
      const Floats along = load(node.axes[3 * k] + lane) * apart.x +
                           load(node.axes[3 * k + 1] + lane) * apart.y +
                           load(node.axes[3 * k + 2] + lane) * apart.z;
      squared += gap_squared(along, Floats{}, load(node.half[k] + lane));
    }
    store(squared, out_squared + lane);
    near |= bits(squared < all(below)) << lane;
  }
  return near & ((1u << node.children) - 1u);
}

}  // namespace
}  // namespace palpate::regions
