// SPDX-License-Identifier: GPL-3.0-or-later
// Two small bodies for either engine.
#pragma once

#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {

struct TwoBalls {
  BakedBody a{bumpy_ball(14, 20, 1), bake::ForEngine::both};
  BakedBody b{bumpy_ball(16, 16, 0.8), bake::ForEngine::both};
};

/// Bumpy balls of radius 1 and 0.8.
inline const TwoBalls& two_balls() {
  static const TwoBalls both;
  return both;
}

}  // namespace palpate::test
