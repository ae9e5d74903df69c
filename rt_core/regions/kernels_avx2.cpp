// SPDX-License-Identifier: Apache-2.0
// The kernels for x86-64 with AVX2; the build sets the flags of this file.
#include "rt_core/regions/kernels.hpp"

#if defined(__AVX2__)

#include "rt_core/regions/box_kernel.hpp"
#include "rt_core/regions/triangle_kernel.hpp"

namespace palpate::regions {

const Kernels* kernels_avx2() noexcept {
  static constexpr Kernels kTable = {"avx2",        test_boxes,       triangle_distances,
                                     triangle_ways, triangle_courses, separations,
                                     witnesses,     point_boxes};
  return &kTable;
}

}  // namespace palpate::regions

#else

namespace palpate::regions {

const Kernels* kernels_avx2() noexcept { return nullptr; }

}  // namespace palpate::regions

#endif
