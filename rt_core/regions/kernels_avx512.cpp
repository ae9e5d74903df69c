// SPDX-License-Identifier: Apache-2.0
// The kernels for x86-64 with AVX-512 F and DQ; the build sets the flags of this file.
#include "rt_core/regions/kernels.hpp"

#if defined(__AVX512F__) && defined(__AVX512DQ__)

#include "rt_core/regions/box_kernel.hpp"
#include "rt_core/regions/triangle_kernel.hpp"

namespace palpate::regions {

const Kernels* kernels_avx512() noexcept {
  static constexpr Kernels kTable = {"avx512",      test_boxes,       triangle_distances,
                                     triangle_ways, triangle_courses, separations,
                                     witnesses,     point_boxes};
  return &kTable;
}

}  // namespace palpate::regions

#else

namespace palpate::regions {

const Kernels* kernels_avx512() noexcept { return nullptr; }

}  // namespace palpate::regions

#endif
