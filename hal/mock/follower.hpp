// SPDX-License-Identifier: Apache-2.0
// Where a hand that is led, by a mouse for instance, wants the tool: it goes to where it is led as
// a hand could, and pulls no harder than it may.
#pragma once

#include <limits>

#include "hal/mock/path.hpp"

namespace palpate::hal::mock {

/// What a led hand is told.
struct Lead {
  bool held = true;  ///< false: the hand lets go, and only damps
  Pose to{};         ///< finite, its quaternion not zero
  /// Not to a place but on at a pace, for ever: `to` means nothing then. It stays near a tool that
  /// is held up, so that turning round is felt at once.
  bool paced = false;
  Twist pace{};  ///< finite
};

/// All > 0.
struct FollowLimits {
  double speed_m_per_s = 1.0;
  double turn_rad_per_s = 6.0;
  /// How far ahead of the tool the hand may want it: times the grip's stiffness, its pull.
  double ahead_m = std::numeric_limits<double>::infinity();
  double ahead_rad = std::numeric_limits<double>::infinity();
  /// The way that is left is gone in so long, where the limits of speed allow it: steps of a mouse
  /// become smooth.
  double settle_s = 0.03;
};

class Follower {
 public:
  Follower(const FollowLimits& limits, const Pose& start) noexcept;

  void lead(const Lead& lead) noexcept;

  /// Moves on by dt_s. @param tool  where it is now. O(1)
  [[nodiscard]] Target advance(const Pose& tool, double dt_s) noexcept;

 private:
  /// As fast as it is gone in settle_s.
  [[nodiscard]] Twist way_left(double dt_s) const noexcept;

  FollowLimits limits_;
  bool held_ = true;
  bool paced_ = false;
  Twist pace_;
  Pose to_;
  Pose at_;
};

}  // namespace palpate::hal::mock
