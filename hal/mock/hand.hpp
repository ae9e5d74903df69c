// SPDX-License-Identifier: Apache-2.0
// A simulated hand holding the tool: a rigid mass on a spring and a damper whose far end follows a
// script, pushed by the wrench that is rendered to it. Deterministic; knows no clock.
//
// Model: m a = F + k (x* - x) + b (v* - v), and the same for rotation with an isotropic inertia
// about the tool's origin, which is also the centre of mass. The common second-order model of a
// hand on a haptic handle, e.g. Colgate and Brown, "Factors affecting the Z-width of a haptic
// display", ICRA 1994; its figures lie in 0.1 to 1 kg, 10 to 1000 N/m, 0 to 5 N s/m.
#pragma once

#include <vector>

#include "hal/device.hpp"
#include "hal/mock/path.hpp"

namespace palpate::hal::mock {

struct HandParameters {
  double mass_kg = 0.3;                ///< > 0
  double inertia_kg_m2 = 1e-4;         ///< > 0
  double grip_N_per_m = 300.0;         ///< >= 0
  double grip_Nm_per_rad = 0.5;        ///< >= 0
  double damping_N_s_per_m = 5.0;      ///< >= 0
  double damping_Nm_s_per_rad = 0.01;  ///< >= 0
  Pose rest;                           ///< where the tool is wanted while the script is empty
  std::vector<Waypoint> script;        ///< see Path
};

/// What the integration's step must stay under, as a share of the hand's fastest time constant 1 /
/// sqrt(k / m). 0.05 keeps the error of the period below 1e-4.
inline constexpr double kMaxStepTimesFrequency = 0.05;

/// The integration's longest step.
inline constexpr double kMaxSubStep_s = 5e-5;

/// Sub-steps that one advance() may take at most.
inline constexpr int kMaxSubSteps = 1000;

/// Why parameters cannot be simulated in steps of dt_s, as a static string naming the parameter;
/// null where they can.
[[nodiscard]] const char* why_refused(const HandParameters& parameters, double dt_s) noexcept;

class Hand {
 public:
  /// Starts at rest on the script's first pose. Parameters must not be refused. @param dt_s  the
  /// length of every advance().
  Hand(const HandParameters& parameters, double dt_s);

  /// Moves on by dt_s under a constant wrench (world axes, about the tool's origin). Cost: a fixed
  /// number of sub-steps, at most kMaxSubSteps. Semi-implicit Euler with the damping taken
  /// implicitly: stable for any damping.
  void advance(const Wrench& wrench) noexcept;

  /// The same with a place where the tool is wanted, in the script's stead.
  void advance(const Wrench& wrench, const Target& target) noexcept;

  [[nodiscard]] const Pose& pose() const noexcept { return pose_; }
  [[nodiscard]] const Twist& twist() const noexcept { return twist_; }
  [[nodiscard]] double time_s() const noexcept;

 private:
  void sub_step(const Wrench& wrench, const Target& target) noexcept;

  HandParameters parameters_;
  Path path_;
  int sub_steps_;
  double step_s_;
  std::uint64_t steps_done_ = 0;  ///< time is counted, not summed: it does not drift in long runs
  Pose pose_;
  Twist twist_;
};

}  // namespace palpate::hal::mock
