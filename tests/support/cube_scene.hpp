// SPDX-License-Identifier: Apache-2.0
// Two cubes of a centimetre, cut into halves so that trees have something to refine: the tool comes
// down on the other along x. The image serves the levels engine only.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "tiny_image.hpp"

namespace palpate::test {

/// The scene's cube.palp.
inline std::string cube_image() {
  const std::vector<Part> halves = {box_part({0, 0, -0.25f}, {0.5f, 0.5f, 0.25f}),
                                    box_part({0, 0, 0.25f}, {0.5f, 0.5f, 0.25f})};
  const auto image = seal(parts_of(halves, 0.01));
  std::string bytes(image.size(), '\0');
  std::memcpy(bytes.data(), image.data(), image.size());
  return bytes;
}

/// @param engine  further keys of [engine]
/// @param rest    further tables
/// @param force   further keys of [force]
inline std::string cube_scene(const std::string& engine = {}, const std::string& rest = {},
                              const std::string& force = {}) {
  return "[engine]\ndelta_m = 0.0005\n" + engine + "\n[force]\nstiffness_N_per_m = 600.0\n" +
         force +
         "[[body]]\nname = \"tool\"\nimage = \"cube.palp\"\nrole = \"tool\"\n"
         "[[body]]\nname = \"wall\"\nimage = \"cube.palp\"\n" +
         rest;
}

/// The same cubes for loops: the tool begins 0.2 mm off a fixed base, with a budget and limits.
/// @param rest  further tables, as the mock's path
inline std::string cube_loop_scene(const std::string& rest = {}) {
  return R"([engine]
delta_m = 0.0005
budget_us = 400.0
[force]
stiffness_N_per_m = 600.0
max_force_N = 0.5
max_torque_Nm = 0.1
[[body]]
name = "tool"
image = "cube.palp"
role = "tool"
position = [0.0102, 0.0, 0.0]
[[body]]
name = "base"
image = "cube.palp"
role = "fixed"
)" + rest;
}

/// A tick a millisecond. The gap shrinks by a step a tick.
inline std::string cube_poses(int ticks, double first_gap_m = 0.001, double step_m = 0.0002) {
  std::string poses = "t,body,px,py,pz,qw,qx,qy,qz\n";
  for (int i = 0; i < ticks; ++i) {
    poses += std::to_string(0.001 * i) + ",tool," +
             std::to_string(0.01 + first_gap_m - step_m * i) + ",0,0,1,0,0,0\n";
  }
  return poses;
}

}  // namespace palpate::test
