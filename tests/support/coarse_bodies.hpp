// SPDX-License-Identifier: GPL-3.0-or-later
// Two small bodies with many levels of detail.
#pragma once

#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {

/// A contact tolerance for bodies of radius 1.
inline constexpr double kDelta = 0.05;

/// Simplified far below what would be kept for a hand, so that small meshes have many levels.
inline bake::BakeOptions coarse() {
  bake::BakeOptions options;
  options.stop.stop_resolution = 1.5;
  return options;
}

struct CoarseBodies {
  BakedBody a{bumpy_ball(24, 32, 1), coarse()};
  BakedBody b{bumpy_ball(20, 28, 0.8), coarse()};
};

/// Bumpy balls of radius 1 and 0.8.
inline const CoarseBodies& bodies() {
  static const CoarseBodies both;
  return both;
}

}  // namespace palpate::test
