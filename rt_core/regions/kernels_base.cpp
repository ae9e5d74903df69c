// SPDX-License-Identifier: Apache-2.0
// The kernels for what every processor of a target with vectors has.
#include "rt_core/regions/simd.hpp"

#if PALPATE_VECTORS

#include "rt_core/regions/box_kernel.hpp"
#include "rt_core/regions/triangle_kernel.hpp"

namespace palpate::regions {

const Kernels* kernels_base() noexcept {
  static constexpr Kernels kTable = {"base",        test_boxes,       triangle_distances,
                                     triangle_ways, triangle_courses, separations,
                                     witnesses,     point_boxes};
  return &kTable;
}

}  // namespace palpate::regions

#else

#include "rt_core/regions/kernels.hpp"

namespace palpate::regions {

const Kernels* kernels_base() noexcept { return nullptr; }

}  // namespace palpate::regions

#endif
