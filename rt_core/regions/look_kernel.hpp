// SPDX-License-Identifier: Apache-2.0
// Where triangles lie in a grid. Private to the kernels.
#pragma once

#include "rt_core/regions/corner_lanes.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/simd.hpp"

namespace palpate::regions {
namespace {

/// Of a corner's way to the second and to the third one.
struct Shares {
  float second[kBatch];
  float third[kBatch];
};

/// Multiples of the plastic number's powers (Roberts 2018) in a parallelogram, of which one half is
/// folded over the other: where numbers follow each other, places are spread over the triangle.
void spread(const std::uint32_t (&numbers)[kBatch], Shares& out) noexcept {
  constexpr std::uint32_t kSteps[] = {0xc13fa9a9u, 0x91e10da5u};
  constexpr float kUnit = 0x1p-24f;
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    const float u = kUnit * static_cast<float>((numbers[i] * kSteps[0] + 0x80000000u) >> 8);
    const float v = kUnit * static_cast<float>((numbers[i] * kSteps[1] + 0x80000000u) >> 8);
    out.second[i] = u + v > 1 ? 1 - u : u;
    out.third[i] = u + v > 1 ? 1 - v : v;
  }
}

/// Whether a triangle has an edge longer than the root of that.
PALPATE_LANES Ints is_longer(Vectors p, Vectors q, Vectors r, float most2) noexcept {
  const Vectors a = q - p, b = r - q, c = p - r;
  return most(most(dot(a, a), dot(b, b)), dot(c, c)) > all(most2);
}

/// Into the coordinates of the grid, to the bits of at_place() (look.hpp).
PALPATE_LANES Vectors brought_over(Vectors p, const Transform& m) noexcept {
  const float* r = m.rotation;
  const float* t = m.translation;
  return {m.scale * (r[0] * p.x + r[1] * p.y + r[2] * p.z) + t[0],
          m.scale * (r[3] * p.x + r[4] * p.y + r[5] * p.z) + t[1],
          m.scale * (r[6] * p.x + r[7] * p.y + r[8] * p.z) + t[2]};
}

/// What lies outside of the grid is in the outermost cells.
PALPATE_LANES Ints cells_along(Floats place, const image::ProximityGrid& grid, int axis) noexcept {
  const Floats last = all(static_cast<float>(grid.bricks[axis] * image::kBrickEdge - 1));
  const Floats at = (place - grid.origin[axis]) * (1 / grid.cell);
  return truncated(least(most(at, Floats{}), last));
}

void find_bricks(const image::RegionTriangle* const (&from)[kBatch],
                 const std::uint32_t (&numbers)[kBatch], float long2, const Transform& to_grid,
                 const image::ProximityGrid& grid, BrickLanes& out) noexcept {
  static_assert(image::kBrickEdge == 4);
  constexpr int kShift = 2;
  constexpr std::int32_t kWithin = image::kBrickEdge - 1;
  Shares shares;
  bool is_spread = false;
  for (int lane = 0; lane < static_cast<int>(kBatch); lane += kLanes) {
    const CornerLanes corners = corners_of(from + lane);
    const Vectors p = corners.corner[0], q = corners.corner[1], r = corners.corner[2];
    Vectors place = all(1.0f / 3) * (p + q + r);
    const Ints is_long = is_longer(p, q, r, long2);
    if (bits(is_long) != 0) {
      if (!is_spread) spread(numbers, shares);
      is_spread = true;
      const Floats second = load(shares.second + lane), third = load(shares.third + lane);
      place = select(is_long, p + second * (q - p) + third * (r - p), place);
    }
    const Vectors at = brought_over(place, to_grid);
    const Ints x = cells_along(at.x, grid, 0);
    const Ints y = cells_along(at.y, grid, 1);
    const Ints z = cells_along(at.z, grid, 2);
    const auto across = static_cast<std::int32_t>(grid.bricks[0]);
    const auto rows = static_cast<std::int32_t>(grid.bricks[1]);
    const Ints brick = ((z >> kShift) * rows + (y >> kShift)) * across + (x >> kShift);
    const Ints within = (((z & kWithin) << kShift | (y & kWithin)) << kShift) | (x & kWithin);
    store(brick, out.brick + lane);
    store(within, out.in_brick + lane);
  }
}

}  // namespace
}  // namespace palpate::regions
