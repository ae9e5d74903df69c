// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/touch_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/palpate/motion_placing.hpp"
#include "tools/palpate/poses.hpp"

namespace palpate::cli {
namespace {

constexpr double kStep_s = 0.01;
constexpr double kDown = 0.25, kUp = 0.85;  // shares of the time: pressed between
constexpr double kHigh = 2.5;               // gap in delta at the ends
constexpr double kPressed = -5;             // likewise: what the hand wants, and contacts hold off

double gap_at(double share) {
  const double off = std::max({0.0, 1 - share / kDown, (share - kUp) / (1 - kUp)});
  return kPressed + off * (kHigh - kPressed);
}

/// -1 to 1, there and back twice between kDown and kUp.
double slide_at(double share) {
  const double pressed = std::clamp((share - kDown) / (kUp - kDown), 0.0, 1.0);
  return std::sin(2 * std::numbers::pi * pressed);
}

}  // namespace

std::string touch_motion(const config::Scene& scene, const NewScene& made, double seconds,
                         const bake::Progress& progress) {
  MotionPlacing placing(scene);
  std::string text = std::string(kPosesHeader) + "\n";
  const auto steps = static_cast<std::size_t>(std::ceil(seconds / kStep_s));
  for (std::size_t i = 0; i <= steps; ++i) {
    const double share = double(i) / double(steps);
    Waymark at = made.start;
    at.pose.position_m += (made.slide_m * slide_at(share)) * made.across;
    at.gap = gap_at(share);
    const Pose pose = placing.place(at, Closing::from_outside);
    text += pose_row(kStep_s * double(i), scene.bodies[scene.tool].name, pose);
    progress("motion", share);
  }
  return text;
}

}  // namespace palpate::cli
