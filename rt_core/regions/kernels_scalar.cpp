// SPDX-License-Identifier: Apache-2.0
// The kernels one lane at a time, for every target.
#define PALPATE_SCALAR
#include "rt_core/regions/box_kernel.hpp"
#include "rt_core/regions/triangle_kernel.hpp"

namespace palpate::regions {

const Kernels* kernels_scalar() noexcept {
  static constexpr Kernels kTable = {"scalar",      test_boxes,       triangle_distances,
                                     triangle_ways, triangle_courses, separations,
                                     witnesses,     point_boxes};
  return &kTable;
}

}  // namespace palpate::regions
