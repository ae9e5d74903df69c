// SPDX-License-Identifier: GPL-3.0-or-later
// Poses at which both engines are tried, and what has to hold at any of them.
#pragma once

#include <random>

#include "tests/support/baked_scene.hpp"
#include "tests/support/brute_force.hpp"

namespace palpate::test {

inline Vec3d random_unit(std::mt19937& rng) {
  std::normal_distribution<double> g;
  const Vec3d v{g(rng), g(rng), g(rng)};
  return (1 / norm(v)) * v;
}

/// A pose of a around b in which they are `gap` apart along a direction, found by conservative
/// advancement from `far` away.
inline Pose approach(const bake::Mesh& a, const bake::Mesh& b, double gap, double far,
                     Vec3d direction, Quat orientation) {
  Pose pose{far * direction, orientation};
  const PlacedTriangles fixed(b, {});
  for (int i = 0; i < 40; ++i) {
    const double d = distance_of(PlacedTriangles(a, pose), fixed);
    if (d <= gap * 1.001) break;
    pose.position_m -= (d - gap) * direction;
  }
  return pose;
}

/// Calls visit(poses of a and b) at gaps of 0.1, 0.4 and 0.7 delta: `jumps` times at a random place
/// and turn, then twice near it.
template <class Visit>
void for_each_placement(const BakedBody& a, const BakedBody& b, double delta, int jumps,
                        Visit visit) {
  const double unit = std::max(a.view.header->radius_m, b.view.header->radius_m);
  std::mt19937 rng(11);
  for (int jump = 0; jump < jumps; ++jump) {
    Vec3d direction = random_unit(rng);
    Quat orientation = turn(3.0 * random_unit(rng));
    for (int step = 0; step < 3; ++step) {
      const double gap = delta * (0.1 + 0.3 * step);
      const Pose poses[2] = {approach(a.mesh, b.mesh, gap, 4 * unit, direction, orientation), {}};
      visit(poses);
      direction = direction + 0.01 * random_unit(rng);
      direction = (1 / norm(direction)) * direction;
      orientation = turn(0.01 * random_unit(rng)) * orientation;
    }
  }
}

/// A slide of one bumpy ball (radius 1) over another (radius 0.8).
inline Pose slid(int i) {
  return {{1.81 - 0.0002 * i, 0.1, 0.002 * i}, turn({0.3 + 0.003 * i, 0.2, 0.001 * i})};
}

/// One motion, pose_at(0) to pose_at(ticks - 1), in two engines of one scene of two bodies, in the
/// second with both bodies moved rigidly: the wrench turns with them.
template <class PoseAt>
void expect_wrench_turns_with_the_world(BakedScene& one, BakedScene& other, int ticks,
                                        PoseAt pose_at) {
  const Pose world{{3, -2, 5}, turn({0.7, -1.1, 0.4})};
  const Mat3d r = rotation(world.orientation);
  for (int i = 0; i < ticks; ++i) {
    const Pose poses[2] = {pose_at(i), {}};
    Pose moved[2];
    for (int k = 0; k < 2; ++k) {
      moved[k] = {world.position_m + r * poses[k].position_m,
                  world.orientation * poses[k].orientation};
    }
    const Wrench w = tick_or_fail(*one.engine, poses).wrench;
    const Wrench v = tick_or_fail(*other.engine, moved).wrench;
    EXPECT_NEAR(norm(r * w.force_N - v.force_N), 0, 1e-4 * (norm(w.force_N) + 1e-3));
    EXPECT_NEAR(norm(r * w.torque_Nm - v.torque_Nm), 0, 1e-4 * (norm(w.torque_Nm) + 1e-3));
  }
}

}  // namespace palpate::test
