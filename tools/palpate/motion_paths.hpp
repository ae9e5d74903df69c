// SPDX-License-Identifier: GPL-3.0-or-later
// The benchmark motions: where the tool is to be, before it is brought to its gap.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rt_core/geometry/pose.hpp"

namespace palpate::cli {

/// How a motion comes by its gap.
enum class Closing {
  from_outside,  ///< the tool comes along the approach until the gap is there
  from_inside,   ///< the tool sits with clearance all around and is pressed to one side
};

struct Motion {
  std::string_view name;
  std::string_view scene;  ///< of config/scenes
  std::string_view what;   ///< one line for --help
  Closing closing;
};

/// In the order in which help lists them.
std::span<const Motion> motions();

/// One tick before placing, in the coordinates of the body that is touched.
struct Waymark {
  Pose pose;         ///< of the tool
  Vec3d approach{};  ///< unit; the tool gets nearer along it
  double gap =
      0;  ///< wanted, in contact tolerances; from_inside: in the clearance where that is less
};

/// @param share  of the motion that is over, in [0, 1)
/// @param seed   changes phases
/// The dimensions are those of the models of make-model. Continuous in share; at 2,000 ticks of a
/// millisecond the tool moves by hand's speeds, up to some 0.1 m/s and 2 rad/s.
/// @param motion  one of motions()
Waymark waymark(const Motion& motion, double share, std::uint64_t seed);

}  // namespace palpate::cli
