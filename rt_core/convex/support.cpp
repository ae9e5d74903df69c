// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/support.hpp"

#include "rt_core/base/assert.hpp"

namespace palpate::convex {
namespace {

std::uint32_t scan(const Hull& hull, Vec3d direction) noexcept {
  std::uint32_t best = 0;
  double best_dot = dot(direction, position(hull, 0));
  for (std::uint32_t i = 1; i < hull.count; ++i) {
    const double d = dot(direction, position(hull, i));
    if (d > best_dot) {
      best_dot = d;
      best = i;
    }
  }
  return best;
}

}  // namespace

std::uint32_t support(const Hull& hull, Vec3d direction, std::uint32_t start) noexcept {
  PALPATE_ASSERT(hull.count > 0 && start < hull.count);
  if (hull.starts == nullptr) return scan(hull, direction);
  std::uint32_t best = start;
  for (std::uint32_t step = 0; step < kMaxClimbSteps; ++step) {
    const Vec3d here = position(hull, best);
    std::uint32_t next = best;
    double best_rise = 0;
    for (std::uint32_t k = hull.starts[best]; k < hull.starts[best + 1]; ++k) {
      const double rise = dot(direction, position(hull, hull.neighbours[k]) - here);
      if (rise > best_rise) {
        best_rise = rise;
        next = hull.neighbours[k];
      }
    }
    if (next == best) return best;
    best = next;
  }
  return scan(hull, direction);
}

}  // namespace palpate::convex
