// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/path.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hal/rotation.hpp"

namespace palpate::hal::mock {
namespace {

Pose with_unit_orientation(const Pose& pose) {
  return {pose.position_m, normalised(pose.orientation)};
}

bool is_finite(const Pose& pose) {
  const Vec3d& p = pose.position_m;
  const Quat& q = pose.orientation;
  return std::isfinite(p.x + p.y + p.z) && std::isfinite(q.w + q.x + q.y + q.z);
}

}  // namespace

Path::Path(std::span<const Waypoint> waypoints, const Pose& rest) {
  if (waypoints.empty()) {
    segments_.push_back({0, with_unit_orientation(rest), {}});
    return;
  }
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    Segment segment{waypoints[i].t_s, with_unit_orientation(waypoints[i].pose), {}};
    if (i + 1 < waypoints.size()) {
      const Waypoint& next = waypoints[i + 1];
      const double rate = 1.0 / (next.t_s - waypoints[i].t_s);
      segment.twist.linear_m_per_s = rate * (next.pose.position_m - segment.from.position_m);
      segment.twist.angular_rad_per_s =
          rate * rotation_between(segment.from.orientation, normalised(next.pose.orientation));
    }
    segments_.push_back(segment);
  }
  duration_s_ = waypoints.back().t_s;
}

Target Path::at(double t_s) const noexcept {
  const double t = duration_s_ > 0 ? std::fmod(t_s, duration_s_) : 0.0;
  const auto after =
      std::upper_bound(segments_.begin(), segments_.end(), t,
                       [](double time, const Segment& s) { return time < s.start_s; });
  const Segment& segment = after == segments_.begin() ? segments_.front() : *std::prev(after);
  const double elapsed = t - segment.start_s;
  Target target{segment.from, segment.twist};
  target.pose.position_m += elapsed * segment.twist.linear_m_per_s;
  target.pose.orientation =
      rotation_from_vector(elapsed * segment.twist.angular_rad_per_s) * segment.from.orientation;
  return target;
}

bool Path::is_valid(std::span<const Waypoint> waypoints) noexcept {
  double previous = 0;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const double t = waypoints[i].t_s;
    const bool in_order = i == 0 ? t == 0 : t > previous;
    if (!std::isfinite(t) || !in_order || !is_finite(waypoints[i].pose)) return false;
    previous = t;
  }
  return true;
}

}  // namespace palpate::hal::mock
