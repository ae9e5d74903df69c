// SPDX-License-Identifier: Apache-2.0
// A scripted motion: poses at times, repeated for ever.
#pragma once

#include <span>
#include <vector>

#include "hal/device.hpp"

namespace palpate::hal::mock {

/// Where the script wants the tool at a time.
struct Waypoint {
  double t_s = 0;
  Pose pose;
};

/// Where the hand wants the tool, and how fast it wants it to move.
struct Target {
  Pose pose;
  Twist twist;
};

/// Piecewise motion at constant velocity and angular velocity, the short way round; starts again
/// when it ends.
class Path {
 public:
  /// @param waypoints  times finite and strictly ascending from 0, poses finite; none or one: the
  /// tool is wanted at `rest`, or at
  ///                   that one waypoint, for ever. Quaternions are normalised. Not checked here;
  ///                   see is_valid().
  Path(std::span<const Waypoint> waypoints, const Pose& rest);

  /// At a time since the start (s, >= 0). O(log waypoints).
  [[nodiscard]] Target at(double t_s) const noexcept;

  /// Whether times ascend strictly from 0 and every number is finite.
  [[nodiscard]] static bool is_valid(std::span<const Waypoint> waypoints) noexcept;

 private:
  struct Segment {
    double start_s = 0;
    Pose from;
    Twist twist;
  };
  std::vector<Segment> segments_;  ///< at least one
  double duration_s_ = 0;          ///< 0: the script does not move
};

}  // namespace palpate::hal::mock
