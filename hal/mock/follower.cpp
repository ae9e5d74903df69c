// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/follower.hpp"

#include <algorithm>

#include "hal/rotation.hpp"

namespace palpate::hal::mock {
namespace {

/// Shortened to a length.
Vec3d at_most(Vec3d v, double length) {
  const double now = norm(v);
  return now > length ? (length / now) * v : v;
}

}  // namespace

Follower::Follower(const FollowLimits& limits, const Pose& start) noexcept
    : limits_(limits), to_(start), at_(start) {
  lead({true, start});
  at_ = to_;
}

void Follower::lead(const Lead& lead) noexcept {
  held_ = lead.held;
  paced_ = lead.paced;
  pace_ = lead.pace;
  if (held_ && !paced_) to_ = {lead.to.position_m, normalised(lead.to.orientation)};
}

Twist Follower::way_left(double dt_s) const noexcept {
  const double rate = 1 / std::max(limits_.settle_s, dt_s);
  return {rate * (to_.position_m - at_.position_m),
          rate * rotation_between(at_.orientation, to_.orientation)};
}

Target Follower::advance(const Pose& tool, double dt_s) noexcept {
  if (!held_) {
    at_ = tool;
    return {at_, {}};
  }
  Target target;
  Twist& twist = target.twist;
  twist = paced_ ? pace_ : way_left(dt_s);
  twist.linear_m_per_s = at_most(twist.linear_m_per_s, limits_.speed_m_per_s);
  twist.angular_rad_per_s = at_most(twist.angular_rad_per_s, limits_.turn_rad_per_s);
  at_.position_m += dt_s * twist.linear_m_per_s;
  at_.orientation =
      normalised(rotation_from_vector(dt_s * twist.angular_rad_per_s) * at_.orientation);

  // Held up, it waits: the grip's damper must not add to the pull.
  const Vec3d ahead_m = at_.position_m - tool.position_m;
  if (norm(ahead_m) > limits_.ahead_m) {
    at_.position_m = tool.position_m + at_most(ahead_m, limits_.ahead_m);
    twist.linear_m_per_s = {};
  }
  const Vec3d ahead_rad = rotation_between(tool.orientation, at_.orientation);
  if (norm(ahead_rad) > limits_.ahead_rad) {
    at_.orientation =
        rotation_from_vector(at_most(ahead_rad, limits_.ahead_rad)) * normalised(tool.orientation);
    twist.angular_rad_per_s = {};
  }
  target.pose = at_;
  return target;
}

}  // namespace palpate::hal::mock
