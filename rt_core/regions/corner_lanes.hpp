// SPDX-License-Identifier: Apache-2.0
// Triangles side by side. Private to the kernels.
#pragma once

#include "rt_core/image/region_format.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/simd.hpp"

namespace palpate::regions {
namespace {

/// Of as many triangles as there are lanes, as they are stored: in the coordinates of their image.
struct CornerLanes {
  Vectors corner[3];
};

#if PALPATE_VECTORS

/// Four components of a triangle in every four lanes, and of the next one, ...
struct Rows {
  Floats of[4];
};

PALPATE_LANES Rows rows_of(const image::RegionTriangle* const* from, int component) noexcept {
  Rows rows;
  for (int i = 0; i < 4; ++i) {
    const float* at[kLanes / 4];
    for (int k = 0; k < kLanes / 4; ++k) at[k] = from[4 * k + i]->corners + component;
    rows.of[i] = fours(at);
  }
  return rows;
}

/// Each component of all: four by four, turned over.
PALPATE_LANES void turn_over(const Rows& rows, Floats (&out)[4]) noexcept {
  const Floats first01 = low_mixed(rows.of[0], rows.of[1]);
  const Floats first23 = low_mixed(rows.of[2], rows.of[3]);
  const Floats last01 = high_mixed(rows.of[0], rows.of[1]);
  const Floats last23 = high_mixed(rows.of[2], rows.of[3]);
  out[0] = low_halves(first01, first23);
  out[1] = high_halves(first01, first23);
  out[2] = low_halves(last01, last23);
  out[3] = high_halves(last01, last23);
}

/// In registers all the way: what is stored by fours cannot be read by more before it has reached
/// the cache.
/// @param from  as many as there are lanes; one may be named more than once
PALPATE_LANES CornerLanes corners_of(const image::RegionTriangle* const* from) noexcept {
  Floats first[4], second[4], last[4];
  turn_over(rows_of(from, 0), first);
  turn_over(rows_of(from, 4), second);
  turn_over(rows_of(from, 5), last);
  return {{{first[0], first[1], first[2]},
           {first[3], second[0], second[1]},
           {second[2], second[3], last[3]}}};
}

#else

PALPATE_LANES CornerLanes corners_of(const image::RegionTriangle* const* from) noexcept {
  const float* c = from[0]->corners;
  return {{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}};
}

#endif

}  // namespace
}  // namespace palpate::regions
