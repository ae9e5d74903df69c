// SPDX-License-Identifier: GPL-3.0-or-later
// Gears of triangles like needles, of which looks and boxes tell least.
#pragma once

#include <random>

#include "tests/support/baked_scene.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {

/// Turned at random, and brought to this distance from a random direction.
inline Pose met_at_random(const bake::Mesh& a, const bake::Mesh& b, double apart,
                          std::mt19937& rng) {
  const Vec3d direction = random_unit(rng);
  return approach(a, b, apart, 4, direction, turn(3.0 * random_unit(rng)));
}

/// Whose flanks are regions of their own, fifty tolerances long.
struct Gears {
  static constexpr double kDelta = 0.02;

  Gears(std::uint32_t teeth_of_a, std::uint32_t teeth_of_b)
      : a(gear(teeth_of_a, 1, 0.5), options()), b(gear(teeth_of_b, 0.9, 0.5), options()) {}
  BakedScene scene(const Settings& settings = {.engine = EngineKind::regions,
                                               .delta_m = kDelta}) const {
    return {{a.view, b.view}, {{0, 1}}, settings};
  }
  /// For distances alone.
  BakedScene distances() const {
    return scene(
        {.engine = EngineKind::regions, .delta_m = kDelta, .exact = true, .stiffness_N_per_m = 0});
  }
  static bake::BakeOptions options() {
    bake::BakeOptions options = options_for(bake::ForEngine::regions);
    options.delta_rel = kDelta;
    return options;
  }

  BakedBody a, b;
};

/// The least distance of a and b there, or delta.
inline double distance_at(BakedScene& distances, const Pose& pose) {
  const Pose poses[2] = {pose, {}};
  const TickResult r = tick_or_fail(*distances.engine, poses);
  return r.contacts.empty() ? Gears::kDelta : r.min_distance_m;
}

/// One gear upon another, and how it goes on from there.
struct Slide {
  Slide(BakedScene& distances, std::mt19937& rng)
      : down(random_unit(rng)),
        axis(random_unit(rng)),
        pose{2.5 * down, turn(3.0 * random_unit(rng))} {
    while (distance_at(distances, pose) > 0.4 * Gears::kDelta) {
      pose.position_m -= (distance_at(distances, pose) - 0.3 * Gears::kDelta) * down;
    }
  }
  void go_on(double way) {
    pose.position_m += way * cross(down, axis);
    pose.orientation = turn(way * axis) * pose.orientation;
  }
  Vec3d down, axis;
  Pose pose;
};

}  // namespace palpate::test
