// SPDX-License-Identifier: Apache-2.0
// Virtual coupling: a simulated tool between the contacts and the hand.
//
// Source: Colgate, Stanley and Brown, Issues in the haptic display of tool use, IROS 1995; implicit
// integration after Otaduy and Lin, A modular haptic rendering algorithm for stable and transparent
// 6-DOF manipulation, IEEE Trans. Robotics 22(4), 2006.
#pragma once

#include "rt_core/geometry/matrix6.hpp"

namespace palpate::force {

/// All > 0 but for the damping.
struct CouplingSettings {
  double spring_N_per_m = 1000;
  double spring_Nm_per_rad = 1;
  double mass_kg = 0.05;         ///< of the simulated tool
  double inertia_kg_m2 = 2e-5;   ///< about its origin, every axis; its centre of mass is there
  double contact_damping_s = 0;  ///< of the contacts, over their stiffness; >= 0
};

/// The simulated tool. The hand feels the spring and damper that tie it to the handle, and nothing
/// of the contacts themselves: however stiff they are, the device displays no more than the spring.
class VirtualTool {
 public:
  explicit VirtualTool(const CouplingSettings& settings) noexcept;

  /// At rest at a pose.
  void reset(const Pose& at) noexcept;

  /// Where the contact query is to be asked.
  [[nodiscard]] const Pose& pose() const noexcept { return pose_; }

  /// Moves on by one period and returns the wrench on the handle, about the handle's origin.
  ///
  /// Backward Euler, linearised once:
  /// (M + T B + T^2 (K + Kc) + T d K) v1 = M v0 + T (w + wc + B vh), where d is the contact
  /// damping, wc is the spring at the handle's present pose and vh the handle's velocity since the
  /// last step. The damper is critical for spring and mass. K is positive semidefinite, so the
  /// matrix is definite and the tool is stable against contacts of any stiffness. The angle of the
  /// spring is that of displacement().
  /// @param handle     unit quaternion
  /// @param contact    wrench of the contacts at pose()
  /// @param stiffness  of the same: how it falls as the tool moves
  /// @param period_s   > 0
  /// Cost: constant. No memory.
  Wrench step(const Pose& handle, const Wrench& contact, const Matrix6& stiffness,
              double period_s) noexcept;

 private:
  CouplingSettings settings_;
  double damper_N_s_per_m_;
  double damper_Nm_s_per_rad_;
  Pose pose_;
  Vec6 velocity_{};
  Pose handle_before_;
};

}  // namespace palpate::force
