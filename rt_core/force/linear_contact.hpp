// SPDX-License-Identifier: Apache-2.0
// What a tick tells of the wrench nearby, in space and in velocity: for loops faster than the
// contact query, and for contacts that are damped.
//
// Source: the linearised contact model of Otaduy and Lin, A modular haptic rendering algorithm for
// stable and transparent 6-DOF manipulation, IEEE Trans. Robotics 22(4), 2006. Departure: shares
// and normals are held, which keeps the stiffness positive semidefinite.
#pragma once

#include "rt_core/geometry/matrix6.hpp"

namespace palpate::force {

/// A tick's answer (TickResult) and where it was asked.
struct LinearContact {
  Pose tool;  ///< unit quaternion
  Wrench wrench;
  Matrix6 stiffness;
};

/// The wrench at a pose nearby: wrench - stiffness * displacement. Contacts neither come nor go, so
/// that surfaces that part hold on to the tool until the next tick, with at most the stiffness
/// times the way gone. O(1), the same operations always.
[[nodiscard]] Wrench predicted(const LinearContact& contact, const Pose& tool) noexcept;

/// The wrench with contacts that resist velocity as well: wrench - damping_s * stiffness *
/// velocity, the second part scaled down to the length of the first one's force. So it begins with
/// no jump where contacts do, and never pulls the tool towards a surface.
/// @param velocity   of the tool, world axes  @param damping_s  damping over stiffness, s; >= 0
/// O(1)
[[nodiscard]] Wrench damped(const Wrench& wrench, const Matrix6& stiffness, const Vec6& velocity,
                            double damping_s) noexcept;

}  // namespace palpate::force
