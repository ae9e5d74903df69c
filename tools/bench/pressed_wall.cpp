// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/pressed_wall.hpp"

#include <algorithm>
#include <cmath>

#include "hal/mock/hand.hpp"
#include "rt_core/force/coupling.hpp"
#include "tools/realtime/passivity.hpp"

namespace palpate::bench {
namespace {

constexpr double kPress_N = 1, kWatch_s = 3;
constexpr double kQuietSteps = 4;
/// A swing that keeps this much of itself over a second does not end.
constexpr double kKept = 0.98;

hal::mock::HandParameters hand_of(const PressedWall& w) {
  const auto at_z = [](double z_m) {
    Pose pose;
    pose.position_m.z = z_m;
    return pose;
  };
  const double reach_m = kPress_N / w.grip_N_per_m;
  hal::mock::HandParameters hand;
  hand.mass_kg = w.mass_kg;
  hand.damping_N_s_per_m = w.damping_N_s_per_m;
  hand.grip_N_per_m = w.grip_N_per_m;
  hand.script = {{0, at_z(0.001)}, {0.2, at_z(-reach_m)}, {1000, at_z(-reach_m)}};
  return hand;
}

class Loop {
 public:
  explicit Loop(const PressedWall& w)
      : wall_(w),
        period_s_(1 / w.rate_Hz),
        step_m_(kEncoderSpan_m / std::exp2(w.encoder_bits)),
        hand_(hand_of(w), period_s_),
        tool_(coupling_of(w)) {
    tool_.reset(read());
    before_m_ = read().position_m.z;
  }

  void tick() {
    const Pose reading = read();
    passivity_.observe(in_force_, {0, 0, reading.position_m.z - before_m_}, {}, period_s_);
    before_m_ = reading.position_m.z;
    Wrench next = wall_.felt == Felt::direct ? push(reading.position_m.z, wall_.stiffness_N_per_m)
                                             : couple(reading);
    if (wall_.passivity_control) next = passivity_.control(next, period_s_);
    in_force_ = next_;
    next_ = next;
    hand_.advance(in_force_);
  }

  /// Between the farthest places of the hand in so many seconds.
  double swing_m(double seconds) {
    double low_m = hand_.pose().position_m.z, high_m = low_m;
    for (double t_s = 0; t_s < seconds; t_s += period_s_) {
      tick();
      low_m = std::min(low_m, hand_.pose().position_m.z);
      high_m = std::max(high_m, hand_.pose().position_m.z);
    }
    return high_m - low_m;
  }

  [[nodiscard]] double step_m() const { return step_m_; }

 private:
  static force::CouplingSettings coupling_of(const PressedWall& w) {
    force::CouplingSettings s;
    s.spring_N_per_m = w.stiffness_N_per_m;
    return s;
  }
  [[nodiscard]] Pose read() const {
    Pose pose;
    pose.position_m.z = step_m_ * std::round(hand_.pose().position_m.z / step_m_);
    return pose;
  }
  static Wrench push(double z_m, double stiffness_N_per_m) {
    return {{0, 0, z_m < 0 ? -stiffness_N_per_m * z_m : 0}, {}};
  }
  Wrench couple(const Pose& handle) {
    const double z_m = tool_.pose().position_m.z;
    Matrix6 stiffness;
    if (z_m < 0) stiffness.add_square({0, 0, 1, 0, 0, 0}, kHardWall_N_per_m);
    return tool_.step(handle, push(z_m, kHardWall_N_per_m), stiffness, period_s_);
  }

  PressedWall wall_;
  double period_s_;
  double step_m_;
  hal::mock::Hand hand_;
  force::VirtualTool tool_;
  realtime::PassivityController passivity_;
  Wrench in_force_, next_;
  double before_m_ = 0;
};

}  // namespace

bool comes_to_rest(const PressedWall& wall) {
  constexpr double kWindow_s = 0.5;
  Loop loop(wall);
  static_cast<void>(loop.swing_m(kWatch_s - 1 - 2 * kWindow_s));
  const double first_m = loop.swing_m(kWindow_s);
  static_cast<void>(loop.swing_m(1));
  const double last_m = loop.swing_m(kWindow_s);
  return last_m <= kQuietSteps * loop.step_m() || last_m < kKept * first_m;
}

double passive_stiffness(const PressedWall& wall) {
  const double period_s = 1 / wall.rate_Hz;
  return realtime::largest_passive_stiffness(wall.damping_N_s_per_m, 0, period_s, period_s);
}

double largest_stable_stiffness(PressedWall wall) {
  constexpr double kClose = 1.04;
  double low = kLeastStiffness_N_per_m, high = kMostStiffness_N_per_m;
  while (high / low > kClose) {
    wall.stiffness_N_per_m = std::sqrt(low * high);
    (comes_to_rest(wall) ? low : high) = wall.stiffness_N_per_m;
  }
  return low;
}

}  // namespace palpate::bench
