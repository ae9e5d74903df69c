// SPDX-License-Identifier: Apache-2.0
// The simulated hand against the closed forms of a damped oscillator.
#include "hal/mock/hand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "hal/rotation.hpp"
#include "tests/support/poses.hpp"

namespace palpate::hal::mock {
namespace {

using palpate::test::at_x;

constexpr double kDt_s = 5e-4;

/// Times at which a signal about zero rises through it, by linear interpolation.
std::vector<double> rising_zeros(const std::vector<double>& signal, double dt_s) {
  std::vector<double> zeros;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    if (signal[i - 1] < 0 && signal[i] >= 0) {
      const double share = -signal[i - 1] / (signal[i] - signal[i - 1]);
      zeros.push_back((static_cast<double>(i - 1) + share) * dt_s);
    }
  }
  return zeros;
}

/// Pushed by a constant wrench from rest: the way from the new equilibrium, component x of position
/// and of rotation.
struct Response {
  std::vector<double> position_m, rotation_rad;
};

Response response_to(const Wrench& wrench, const HandParameters& p, double seconds) {
  Hand hand(p, kDt_s);
  Response r;
  for (double t = 0; t < seconds; t += kDt_s) {
    r.position_m.push_back(hand.pose().position_m.x - wrench.force_N.x / p.grip_N_per_m);
    r.rotation_rad.push_back(vector_from_rotation(hand.pose().orientation).x -
                             wrench.torque_Nm.x / p.grip_Nm_per_rad);
    hand.advance(wrench);
  }
  return r;
}

Wrench push() { return {{1.5, 0, 0}, {0.05, 0, 0}}; }

TEST(Hand, without_damping_swings_at_the_natural_period) {
  HandParameters p;
  p.damping_N_s_per_m = 0;
  p.damping_Nm_s_per_rad = 0;
  const Response r = response_to(push(), p, 2.0);
  const double period_s = 2 * std::numbers::pi * std::sqrt(p.mass_kg / p.grip_N_per_m);
  const auto zeros = rising_zeros(r.position_m, kDt_s);
  ASSERT_GE(zeros.size(), 5u);
  EXPECT_NEAR((zeros[4] - zeros[0]) / 4, period_s, 0.001 * period_s);

  const double turn_period_s =
      2 * std::numbers::pi * std::sqrt(p.inertia_kg_m2 / p.grip_Nm_per_rad);
  const auto turn_zeros = rising_zeros(r.rotation_rad, kDt_s);
  ASSERT_GE(turn_zeros.size(), 11u);
  EXPECT_NEAR((turn_zeros[10] - turn_zeros[0]) / 10, turn_period_s, 0.001 * turn_period_s);
}

TEST(Hand, without_damping_keeps_its_amplitude_for_long) {
  HandParameters p;
  p.damping_N_s_per_m = 0;
  const Response r = response_to(push(), p, 30.0);
  const auto half = r.position_m.begin() + static_cast<std::ptrdiff_t>(r.position_m.size() / 2);
  const double amplitude = push().force_N.x / p.grip_N_per_m;
  EXPECT_NEAR(*std::max_element(half, r.position_m.end()), amplitude, 0.002 * amplitude);
}

TEST(Hand, with_damping_follows_the_closed_form) {
  const HandParameters p;
  const double decay = p.damping_N_s_per_m / (2 * p.mass_kg);
  const double w = std::sqrt(p.grip_N_per_m / p.mass_kg - decay * decay);
  const double amplitude = push().force_N.x / p.grip_N_per_m;
  const Response r = response_to(push(), p, 0.5);
  for (std::size_t i = 0; i < r.position_m.size(); ++i) {
    const double t = static_cast<double>(i) * kDt_s;
    const double exact =
        -amplitude * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
    ASSERT_NEAR(r.position_m[i], exact, 0.005 * amplitude) << "t = " << t;
  }
}

TEST(Hand, under_constant_wrench_rests_at_wrench_over_stiffness) {
  const HandParameters p;
  Hand hand(p, kDt_s);
  for (int i = 0; i < 6000; ++i) hand.advance(push());
  EXPECT_NEAR(hand.pose().position_m.x, push().force_N.x / p.grip_N_per_m, 1e-9);
  EXPECT_NEAR(vector_from_rotation(hand.pose().orientation).x,
              push().torque_Nm.x / p.grip_Nm_per_rad, 1e-9);
  EXPECT_NEAR(norm(hand.twist().linear_m_per_s), 0, 1e-9);
}

TEST(Hand, follows_a_moving_script_without_lag) {
  // The damper pulls towards the script's velocity, so at constant velocity nothing is left to lag
  // by.
  HandParameters p;
  p.script = {{0, at_x(0)}, {10, at_x(1)}};
  p.script[1].pose.orientation = rotation_from_vector({0, 2, 0});
  Hand hand(p, kDt_s);
  for (int i = 0; i < 8000; ++i) hand.advance({});
  EXPECT_NEAR(hand.time_s(), 4.0, 1e-9);
  EXPECT_NEAR(hand.pose().position_m.x, 0.4, 1e-4);
  EXPECT_NEAR(hand.twist().linear_m_per_s.x, 0.1, 1e-6);
  EXPECT_NEAR(vector_from_rotation(hand.pose().orientation).y, 0.8, 1e-4);
}

TEST(Hand, starts_at_rest_on_the_scripts_first_pose) {
  HandParameters p;
  p.script = {{0, at_x(0.1)}, {1, at_x(0.2)}};
  const Hand hand(p, kDt_s);
  EXPECT_EQ(hand.pose().position_m.x, 0.1);
  EXPECT_EQ(norm(hand.twist().linear_m_per_s), 0.0);
}

TEST(Hand, stays_finite_where_damping_is_stiff) {
  HandParameters p;
  p.mass_kg = 0.01;
  p.damping_N_s_per_m = 1e4;
  p.damping_Nm_s_per_rad = 1e3;
  Hand hand(p, kDt_s);
  for (int i = 0; i < 2000; ++i) hand.advance(push());
  EXPECT_LT(norm(hand.pose().position_m), push().force_N.x / p.grip_N_per_m);
}

TEST(Hand, bad_parameters_are_refused_with_a_reason) {
  const auto reason = [](auto change) {
    HandParameters p;
    change(p);
    const char* why = why_refused(p, kDt_s);
    return std::string(why == nullptr ? "" : why);
  };
  EXPECT_EQ(reason([](HandParameters&) {}), "");
  EXPECT_NE(reason([](HandParameters& p) { p.mass_kg = 0; }).find("mass"), std::string::npos);
  EXPECT_NE(reason([](HandParameters& p) { p.inertia_kg_m2 = -1; }).find("inertia"),
            std::string::npos);
  EXPECT_NE(reason([](HandParameters& p) { p.grip_N_per_m = -1; }).find("grip"), std::string::npos);
  EXPECT_NE(reason([](HandParameters& p) {
              p.damping_N_s_per_m = std::numeric_limits<double>::infinity();
            }).find("damping"),
            std::string::npos);
  EXPECT_NE(reason([](HandParameters& p) { p.grip_N_per_m = 1e12; }).find("stiff"),
            std::string::npos);
  EXPECT_NE(reason([](HandParameters& p) {
              p.script = {{1, {}}};
            }).find("script"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::hal::mock
