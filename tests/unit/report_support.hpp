// SPDX-License-Identifier: GPL-3.0-or-later
// Small recordings for the tests of reports: two cubes of a centimetre, the tool coming down on the
// other along x.
#pragma once

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/tiny_image.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/replay_csv.hpp"

namespace palpate::test {

inline std::string cube_image() {
  const std::vector<Part> halves = {box_part({0, 0, -0.25f}, {0.5f, 0.5f, 0.25f}),
                                    box_part({0, 0, 0.25f}, {0.5f, 0.5f, 0.25f})};
  const auto image = seal(parts_of(halves, 0.01));
  std::string bytes(image.size(), '\0');
  std::memcpy(bytes.data(), image.data(), image.size());
  return bytes;
}

inline const std::string kCubeScene =
    "[engine]\ndelta_m = 0.0005\n[force]\nstiffness_N_per_m = 600.0\n"
    "[[body]]\nname = \"tool\"\nimage = \"cube.palp\"\nrole = \"tool\"\n"
    "[[body]]\nname = \"wall\"\nimage = \"cube.palp\"\n";

/// The gap shrinks by 0.2 mm a tick, from 1 mm.
inline std::string cube_poses(int ticks) {
  std::string poses = "t,body,px,py,pz,qw,qx,qy,qz\n";
  for (int i = 0; i < ticks; ++i) {
    poses += std::to_string(0.001 * i) + ",tool," + std::to_string(0.011 - 0.0002 * i) +
             ",0,0,1,0,0,0\n";
  }
  return poses;
}

/// Rows that differ from each other in every figure.
inline std::vector<cli::TickRow> some_ticks(std::size_t count) {
  std::vector<cli::TickRow> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i);
    rows[i].t_s = 0.001 * x;
    rows[i].wrench.force_N = {0.1 * x, 0, 0};
    rows[i].min_distance_m = i == 0 ? std::nan("") : 1e-4 / x;
    rows[i].front_nodes = 10 + i;
    rows[i].time_ns = 1000 * (i + 1);
    rows[i].certificate.error_bound_m = 1e-5 * (x + 1);
  }
  return rows;
}

/// The message of the failure that `act` ends with; empty where it does not fail.
template <class Act>
std::string failure_of(Act act) {
  try {
    act();
  } catch (const cli::Failure& e) {
    return e.what();
  }
  return {};
}

}  // namespace palpate::test
