// SPDX-License-Identifier: GPL-3.0-or-later
// Sine and cosine of angles in turns, from additions and multiplications alone: C libraries differ
// in the last bit of sin(), and a model must be the same bytes on every machine.
#pragma once

#include <cmath>

namespace palpate::bake {

/// sin(2 pi t) for |t| < 2^50. Absolute error below 5e-16.
inline double sin_turns(double t) {
  t -= std::floor(t + 0.5);
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  // Taylor's series: the first term left out is below 2e-18 at a quarter turn.
  constexpr double kTwoPi = 6.283185307179586476925;
  const double x = kTwoPi * t;
  const double x2 = x * x;
  double sum = 1.0;
  for (int k = 20; k >= 2; k -= 2) sum = 1.0 - sum * x2 / static_cast<double>(k * (k + 1));
  return x * sum;
}

/// cos(2 pi t), likewise.
inline double cos_turns(double t) { return sin_turns(t + 0.25); }

}  // namespace palpate::bake
