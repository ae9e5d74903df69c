// SPDX-License-Identifier: Apache-2.0
// Triangles side by side. Private to source files, as simd.hpp is.
#pragma once

#include "rt_core/image/region_format.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/simd.hpp"

namespace palpate::regions {
namespace {

/// Corners of sixteen triangles, component by component, as they are stored: in the coordinates of
/// their image. A triangle may be named more than once. O(kBatch). Four components of four
/// triangles at a time where there are vectors: stores of single floats would be waited for.
PALPATE_LANES void gather_corners(const image::RegionTriangle* const (&from)[kBatch],
                                  float (&out)[9][kBatch]) noexcept {
#if PALPATE_VECTORS
  for (std::uint32_t i = 0; i < kBatch; i += 4) {
    for (int c = 0; c < 8; c += 4) {
      const Four r0 = four(from[i]->corners + c), r1 = four(from[i + 1]->corners + c);
      const Four r2 = four(from[i + 2]->corners + c), r3 = four(from[i + 3]->corners + c);
      const Four low01 = __builtin_shufflevector(r0, r1, 0, 4, 1, 5);
      const Four high01 = __builtin_shufflevector(r0, r1, 2, 6, 3, 7);
      const Four low23 = __builtin_shufflevector(r2, r3, 0, 4, 1, 5);
      const Four high23 = __builtin_shufflevector(r2, r3, 2, 6, 3, 7);
      store(__builtin_shufflevector(low01, low23, 0, 1, 4, 5), out[c] + i);
      store(__builtin_shufflevector(low01, low23, 2, 3, 6, 7), out[c + 1] + i);
      store(__builtin_shufflevector(high01, high23, 0, 1, 4, 5), out[c + 2] + i);
      store(__builtin_shufflevector(high01, high23, 2, 3, 6, 7), out[c + 3] + i);
    }
    store(Four{from[i]->corners[8], from[i + 1]->corners[8], from[i + 2]->corners[8],
               from[i + 3]->corners[8]},
          out[8] + i);
  }
#else
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    for (int c = 0; c < 9; ++c) out[c][i] = from[i]->corners[c];
  }
#endif
}

}  // namespace
}  // namespace palpate::regions
