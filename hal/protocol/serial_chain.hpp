// SPDX-License-Identifier: Apache-2.0
// Kinematics of devices that send joint counts and take joint torques: a serial chain of revolute
// joints, from their descriptors. Host code: uses libm. All calls O(joints), no memory.
//
// Frame i is reached from frame i-1 by turning alpha about x, moving a along x, turning theta about
// z and moving d along z; the joint turns about z of its frame; the last frame is the tool's.
// Source: Craig, "Introduction to Robotics", 3rd ed., Sec. 3.4 (modified Denavit-Hartenberg).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/protocol/packets.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::hal::protocol {

using JointCounts = std::array<std::int32_t, kMaxJoints>;
using JointTorques = std::array<double, kMaxJoints>;

class SerialChain {
 public:
  SerialChain() = default;  ///< without joints

  /// @param joints  at most kMaxJoints, base first, as decoded
  explicit SerialChain(std::span<const Joint> joints) noexcept;

  [[nodiscard]] std::size_t joints() const noexcept { return count_; }

  /// Whether every joint is within the ends that its descriptor states.
  [[nodiscard]] bool is_within_ends(const JointCounts& counts) const noexcept;

  /// Of the tool: tool to base.
  [[nodiscard]] Pose pose(const JointCounts& counts) const noexcept;

  /// Torques (N m) that give a wrench on the tool, about its origin, in base axes. Where a joint
  /// would exceed its limit all are scaled down, so that the wrench keeps its direction.
  [[nodiscard]] JointTorques torques(const JointCounts& counts,
                                     const Wrench& wrench) const noexcept;

 private:
  struct Link {
    double a_m = 0, d_m = 0;
    double cos_alpha = 1, sin_alpha = 0;
    double theta_offset_rad = 0;
    double rad_per_count = 0;
    std::int32_t zero_counts = 0, min_counts = 0, max_counts = 0;
    double max_torque_Nm = 0;
  };
  struct Frame {
    Mat3d axes;  ///< rows are the base's, columns the frame's axes
    Vec3d origin_m{};
  };
  [[nodiscard]] std::array<Frame, kMaxJoints> frames(const JointCounts& counts) const noexcept;

  std::array<Link, kMaxJoints> links_{};
  std::size_t count_ = 0;
};

}  // namespace palpate::hal::protocol
