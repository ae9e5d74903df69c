// SPDX-License-Identifier: Apache-2.0
// The kernels for every target; the build sets the flags of this file.
#include "rt_core/regions/box_kernel.hpp"
#include "rt_core/regions/triangle_kernel.hpp"

namespace palpate::regions {

const Kernels* kernels_base() noexcept {
  static constexpr Kernels kTable = {"base", test_boxes, triangle_distances, witnesses};
  return &kTable;
}

}  // namespace palpate::regions
