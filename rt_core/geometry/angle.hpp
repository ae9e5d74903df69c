// SPDX-License-Identifier: Apache-2.0
// Angles without a mathematics library.
#pragma once

#include "rt_core/geometry/vec3.hpp"

namespace palpate {

inline constexpr double kPi = 3.14159265358979323846;

/// Arc cosine in radians, right to 2e-8. Abramowitz and Stegun 1964, 4.4.46.
/// @param c  clamped to [-1, 1]
inline double arc_cosine(double c) noexcept {
  const double x = c < 0 ? -c : c;
  if (x >= 1) return c < 0 ? kPi : 0;
  constexpr double kTerms[] = {-0.0012624911, 0.0066700901, -0.0170881256, 0.0308918810,
                               -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050};
  double sum = 0;
  for (const double term : kTerms) sum = sum * x + term;
  const double angle = sqrt_of(1 - x) * sum;
  return c < 0 ? kPi - angle : angle;
}

inline double clamp01(double x) noexcept { return x < 0 ? 0 : x > 1 ? 1 : x; }

}  // namespace palpate
