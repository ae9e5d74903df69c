// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of a force or a torque that may not be true, let in as fast as it usually changes.
#pragma once

#include <cstdint>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::realtime {

/// How much of the tool's motion becomes a change of force, as it was of late.
///
/// A smooth contact that slides changes by a few hundredths of what the stiffness would make of
/// the motion, two surfaces whose details mesh by most of it. The mean over kMemory ticks, or over
/// fewer where there are not so many, begun as if it had been 0 for kSmoothTicks. Single large
/// changes count as kMostTimes the usual one and kMostMore.
class UsualShare {
 public:
  /// @param share  of this tick; what is more than 1 counts as 1
  void note(double share) noexcept;
  [[nodiscard]] double now() const noexcept { return usual_; }

 private:
  static constexpr std::uint32_t kMemory = 64;
  static constexpr std::uint32_t kSmoothTicks = 16;
  static constexpr double kMostTimes = 3;
  static constexpr double kMostMore = 0.1;

  double usual_ = 0;
  std::uint32_t ticks_ = kSmoothTicks;
};

/// What is known of a change before it is let in, in N or N m.
struct Change {
  double certain = 0;  ///< of its length
  double motion = 0;   ///< what the stiffness makes of the tool's motion, in its direction, at most
  double least = 0;    ///< is let in at any rate, so that nothing lags for ever
};

/// Follows the force, or the torque, of contacts: by as much as is certain of its change, and
/// beyond that by no more than is usual. So it is the contacts' own while all is certain; and how
/// far it goes in a tick does not depend on how wrong the contacts were in the last one.
class Doubtful {
 public:
  /// @return the force that is believed by now
  Vec3d follow(const Vec3d& told, const Change& change) noexcept;
  /// The contacts', of the last tick.
  [[nodiscard]] const Vec3d& told() const noexcept { return told_; }
  [[nodiscard]] const Vec3d& believed() const noexcept { return believed_; }

 private:
  Vec3d told_{};
  Vec3d believed_{};
  UsualShare usual_;
};

}  // namespace palpate::realtime
