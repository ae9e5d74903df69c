// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds that become floats stay bounds.
#pragma once

#include <cmath>
#include <limits>

namespace palpate::bake {

/// The least float that is not below the value; infinity beyond the largest one. O(1)
inline float rounded_up(double v) {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) < v ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

}  // namespace palpate::bake
