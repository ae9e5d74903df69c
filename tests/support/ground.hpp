// SPDX-License-Identifier: GPL-3.0-or-later
// Two jaws ground on each other, pressed so that they cross.
#pragma once

#include <cmath>

#include "tests/support/baked_scene.hpp"

namespace palpate::test {

/// Of the upper jaw about the lower one, in ticks of a millisecond; the bite opens and closes by
/// 0.2 mm.
inline Pose ground(double speed_m_per_s, int tick) {
  const double phase = speed_m_per_s * tick;  // a radian a millimetre
  return {{0.001 * std::sin(phase), 0.0005 * (1 - std::cos(phase)),
           -0.00015 + 0.0002 * (1 - std::cos(0.3 * phase))},
          turn({0, 0, 0.01 * std::sin(0.5 * phase)})};
}

}  // namespace palpate::test
