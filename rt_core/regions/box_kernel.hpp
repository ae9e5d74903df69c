// SPDX-License-Identifier: Apache-2.0
// One box against the boxes of a node. Private to the kernels.
#pragma once

#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/simd.hpp"

namespace palpate::regions {
namespace {

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

PALPATE_LANES Floats box_lanes(const Box& box, const image::RegionNode& node, int lane) noexcept {
  const Vectors axis[3] = {
      {load(node.axes[0] + lane), load(node.axes[1] + lane), load(node.axes[2] + lane)},
      {load(node.axes[3] + lane), load(node.axes[4] + lane), load(node.axes[5] + lane)},
      {load(node.axes[6] + lane), load(node.axes[7] + lane), load(node.axes[8] + lane)}};
  const Floats half[3] = {load(node.half[0] + lane), load(node.half[1] + lane),
                          load(node.half[2] + lane)};
  const Vectors apart = {box.x[3] - load(node.centre[0] + lane),
                         box.y[3] - load(node.centre[1] + lane),
                         box.z[3] - load(node.centre[2] + lane)};
  Floats of_box[3] = {};  // half lengths of the single box along the node's axes
  Floats in_box = {};     // sum of squared gaps along the single box's axes
  for (int k = 0; k < 3; ++k) {
    Floats of_node = {};
    for (int i = 0; i < 3; ++i) {
      const Floats cosine =
          magnitude(axis[i].x * box.x[k] + axis[i].y * box.y[k] + axis[i].z * box.z[k]);
      of_box[i] += cosine * box.half[k];
      of_node += cosine * half[i];
    }
    const Floats between = apart.x * box.x[k] + apart.y * box.y[k] + apart.z * box.z[k];
    in_box += gap_squared(between, of_node, all(box.half[k]));
  }
  Floats in_node = {};
  for (int i = 0; i < 3; ++i) in_node += gap_squared(dot(axis[i], apart), of_box[i], half[i]);
  return most(in_box, in_node);
}

std::uint32_t test_boxes(const Box& box, const Transform& to_node, const image::RegionNode& node,
                         float below, float (&out_squared)[kBatch]) noexcept {
  const Box here = mapped(box, to_node);
  std::uint32_t near = 0;
  for (int lane = 0; lane < static_cast<int>(kBatch); lane += kLanes) {
    const Floats squared = box_lanes(here, node, lane);
    store(squared, out_squared + lane);
    near |= bits(squared < all(below)) << lane;
  }
  return near;
}

}  // namespace
}  // namespace palpate::regions
