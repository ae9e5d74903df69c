// SPDX-License-Identifier: GPL-3.0-or-later
// Steps, powers and rounded minima and maxima: what the procedural shapes are blended with.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate::bake {

inline double square(double x) { return x * x; }
inline double fourth(double x) { return square(square(x)); }
inline double mix(double a, double b, double share) { return a + (b - a) * share; }

/// 0 below `low`, 1 above `high`, smooth (C2) between.
inline double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

/// The smaller one, the corner rounded where they differ by less than `width`; never above either
/// of them.
inline double smooth_min(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0);
  return std::min(a, b) - h * h / (4.0 * width);
}

/// The larger one, rounded likewise; never below either of them.
inline double smooth_max(double a, double b, double width) { return -smooth_min(-a, -b, width); }

/// Height of a quarter ellipse: 0 at x = 0, 1 from x = 1 on, upright at 0. Closes tubes with round
/// ends.
inline double round_end(double x) {
  return std::sqrt(std::max(0.0, 1.0 - square(1.0 - std::clamp(x, 0.0, 1.0))));
}

}  // namespace palpate::bake
