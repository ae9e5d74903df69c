// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate {

/// From 0 to 1 as x does, without a kink; constant beyond.
constexpr double smooth_step(double x) noexcept {
  return x <= 0 ? 0 : (x >= 1 ? 1 : x * x * (3 - 2 * x));
}

}  // namespace palpate
