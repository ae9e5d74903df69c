// SPDX-License-Identifier: GPL-3.0-or-later
// Does the loop give out energy of its own, how much stiffness can a device take, and what to do
// where there is too much.
#pragma once

#include "hal/device.hpp"

namespace palpate::realtime {

/// Largest stiffness of a wall that a device with this damping renders without giving out energy:
/// b > K T / 2 + |B| (Colgate and Schenkel, Passivity of a class of sampled-data systems, J.
/// Robotic Systems 14(1), 1997), with the half period of the hold lengthened by the delay between
/// reading and command. Per axis; for rotation, in N m s/rad and N m/rad.
/// @param damping          b, of the device and the hand that always holds it, N s/m
/// @param virtual_damping  B, rendered beside the stiffness, N s/m
/// @param delay_s          from a reading to the command made of it
/// 0 where the damping does not suffice for the virtual one.
[[nodiscard]] double largest_passive_stiffness(double damping, double virtual_damping,
                                               double period_s, double delay_s) noexcept;

/// Work that the hand has done on the scene, less what the scene has given back; the observer of
/// Hannaford and Ryu, Time-domain passivity control of haptic interfaces, IEEE Trans. Robotics and
/// Automation 18(1), 2002. Below zero the loop has given out energy of its own.
class PassivityController {
 public:
  /// Dampers beyond this would shake the hand with the noise of its own readings. >= 0
  struct Limits {
    double damper_N_s_per_m = 10;
    double damper_Nm_s_per_rad = 0.02;
  };

  PassivityController() = default;
  explicit PassivityController(const Limits& limits) noexcept : limits_(limits) {}

  /// A fresh reading: adds the work done against the wrench in force since the last one, and notes
  /// the velocity. Twists that are not finite add nothing. O(1)
  /// @param moved_m, turned_rad  since the last reading  @param elapsed_s  the same; > 0
  void observe(const Wrench& in_force, Vec3d moved_m, Vec3d turned_rad, double elapsed_s) noexcept;

  /// The wrench to send in place of a rendered one: where energy is owed, a damper is added that
  /// takes back as much in the coming period as it can at the velocity observed, within its limits.
  /// Series damper for an impedance display, as in the source, on force and torque alike; the
  /// energy is one sum over all six, so that friction in one direction may pay for another. O(1)
  [[nodiscard]] Wrench control(const Wrench& rendered, double period_s) const noexcept;

  [[nodiscard]] const hal::Twist& velocity() const noexcept { return velocity_; }  ///< observed
  [[nodiscard]] double work() const noexcept { return energy_J_; }                 ///< J
  [[nodiscard]] double least_work() const noexcept { return energy_J_min_; }       ///< J; at most 0

 private:
  Limits limits_;
  double energy_J_ = 0;
  double energy_J_min_ = 0;
  hal::Twist velocity_;
};

}  // namespace palpate::realtime
