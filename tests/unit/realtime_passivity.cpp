// SPDX-License-Identifier: GPL-3.0-or-later
// How stiff a wall may be: the bound, the controller and the virtual coupling, in closed loops with
// a simulated hand in virtual time.
#include "tools/realtime/passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/virtual_loop.hpp"
#include "tools/realtime/coupled_query.hpp"

namespace palpate::realtime {
namespace {

using test::QueryOf;
using test::VirtualLoop;
using test::wall;

TEST(StiffnessBound, follows_damping_rate_and_delay) {
  EXPECT_NEAR(largest_passive_stiffness(5, 0, 0.001, 0), 10000, 1e-9);
  EXPECT_NEAR(largest_passive_stiffness(5, 0, 0.001, 0.001), 5 / 0.0015, 1e-9);
  EXPECT_NEAR(largest_passive_stiffness(5, -2, 0.001, 0), 6000, 1e-9);
  EXPECT_NEAR(largest_passive_stiffness(5, 0, 0.00025, 0), 40000, 1e-9);
  EXPECT_EQ(largest_passive_stiffness(1, 2, 0.001, 0), 0);
}

TEST(PassivityController, counts_the_work_of_the_hand) {
  PassivityController p;
  p.observe({{0, 0, 2}, {}}, {0, 0, -0.001}, {}, 0.001);  // pushed in against 2 N
  EXPECT_NEAR(p.work(), 0.002, 1e-15);
  p.observe({{0, 0, 3}, {0.1, 0, 0}}, {0, 0, 0.001}, {0.01, 0, 0}, 0.001);  // pushed out by more
  EXPECT_NEAR(p.work(), 0.002 - 0.003 - 0.001, 1e-15);
  EXPECT_EQ(p.least_work(), p.work());
}

TEST(PassivityController, leaves_a_scene_alone_that_owes_nothing) {
  PassivityController p;
  p.observe({{0, 0, 2}, {}}, {0, 0, -0.001}, {}, 0.001);
  const Wrench w{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(p.control(w, 0.001).force_N, w.force_N);
  EXPECT_EQ(p.control(w, 0.001).torque_Nm, w.torque_Nm);
}

TEST(PassivityController, takes_back_what_is_owed_and_no_more) {
  PassivityController p;
  p.observe({{0, 0, 1}, {}}, {0, 0, 1e-5}, {}, 0.001);  // owes 1e-5 J at 0.01 m/s
  const Wrench sent = p.control({}, 0.001);
  EXPECT_NEAR(sent.force_N.z, -10 * 0.01, 1e-12);  // its damper's limit
  p.observe(sent, {0, 0, 1e-5}, {}, 0.001);
  EXPECT_NEAR(p.work(), -1e-5 + 1e-6, 1e-15);
  PassivityController q;
  q.observe({{0, 0, 0.01}, {}}, {0, 0, 1e-5}, {}, 0.001);  // owes 1e-7 J
  q.observe(q.control({}, 0.001), {0, 0, 1e-5}, {}, 0.001);
  EXPECT_NEAR(q.work(), 0, 1e-15);
}

TEST(PassivityController, is_not_spoiled_by_a_bad_reading) {
  PassivityController p;
  p.observe({{0, 0, 1}, {}}, {0, 0, 1e-5}, {}, 0.001);
  p.observe({{0, 0, 1}, {}}, {0, 0, std::numeric_limits<double>::quiet_NaN()}, {}, 0.001);
  p.observe({{0, 0, 1}, {}}, {0, 0, 1e-5}, {}, 0);
  EXPECT_NEAR(p.work(), -1e-5, 1e-18);
  const Wrench w{{1, 2, 3}, {}};
  EXPECT_EQ(p.control(w, 0.001).force_N, w.force_N);
}

constexpr double kRate_Hz = 1000;
constexpr double kHandDamping_N_s_per_m = 2;

/// Taps and presses 2 mm into the wall, again and again.
hal::mock::HandParameters tapping_hand() {
  hal::mock::HandParameters hand;
  hand.damping_N_s_per_m = kHandDamping_N_s_per_m;
  const auto at_z = [](double z_m) {
    Pose pose;
    pose.position_m.z = z_m;
    return pose;
  };
  hand.script = {{0, at_z(0.004)},
                 {0.4, at_z(0.004)},
                 {0.5, at_z(-0.002)},
                 {0.9, at_z(-0.002)},
                 {1.0, at_z(0.004)}};
  return hand;
}

LoopReport tapped(const QueryOf::Function& scene, bool control) {
  LoopSettings settings;
  settings.rate_Hz = kRate_Hz;
  settings.periods = 10000;
  settings.passivity_control = control;
  VirtualLoop rig(tapping_hand(), settings, scene);
  return rig.run();
}

/// The readings of the mock device come twice a tick.
double passive_N_per_m() {
  return largest_passive_stiffness(kHandDamping_N_s_per_m, 0, 1 / kRate_Hz, 0.5 / kRate_Hz);
}

/// How far the tool still swings after eight seconds of pressing.
double swing_m(const QueryOf::Function& scene, bool control) {
  hal::mock::HandParameters hand = tapping_hand();
  hand.script.resize(3);
  hand.script.push_back({1000, hand.script.back().pose});
  LoopSettings settings;
  settings.rate_Hz = kRate_Hz;
  settings.periods = 8500;
  settings.passivity_control = control;
  VirtualLoop rig(hand, settings, scene);
  rig.run();
  const auto records = rig.records();
  double low_m = 1, high_m = -1;
  for (std::size_t i = 8000; i < records.size(); ++i) {
    low_m = std::min(low_m, records[i].position_m[2]);
    high_m = std::max(high_m, records[i].position_m[2]);
  }
  return high_m - low_m;
}

TEST(PressedWall, at_the_bound_comes_to_rest) {
  for (const double share : {0.1, 0.5, 1.0}) {
    EXPECT_LT(swing_m(wall(share * passive_N_per_m()), false), 1e-7) << share;
  }
}

TEST(PressedWall, far_beyond_the_bound_swings_unless_controlled) {
  const double free_m = swing_m(wall(4 * passive_N_per_m()), false);
  EXPECT_GT(free_m, 1e-4);
  EXPECT_LT(swing_m(wall(4 * passive_N_per_m()), true), 0.05 * free_m);
}

TEST(TappedWall, far_beyond_the_bound_gives_out_energy_and_control_holds_it_back) {
  const double free_J = tapped(wall(20 * passive_N_per_m()), false).energy_J_min;
  const double held_J = tapped(wall(20 * passive_N_per_m()), true).energy_J_min;
  EXPECT_LT(free_J, -1e-3);
  EXPECT_GT(held_J, 0.25 * free_J);
}

TEST(TappedWall, felt_through_a_coupling_may_be_of_any_stiffness) {
  for (const double stiffness_N_per_m : {1e3, 1e5, 1e7}) {
    QueryOf contacts(wall(stiffness_N_per_m));
    force::CouplingSettings settings;
    settings.spring_N_per_m = 0.5 * passive_N_per_m();
    CoupledQuery coupled(contacts, settings, 1 / kRate_Hz);
    const auto scene = [&coupled](const Pose& tool, const Budget& budget, TickResult& out) {
      return coupled.tick(tool, budget, out);
    };
    const LoopReport r = tapped(scene, false);
    EXPECT_GE(r.energy_J_min, -1e-5) << stiffness_N_per_m;
    EXPECT_GT(r.force_N_max, 0.3) << stiffness_N_per_m;
  }
}

}  // namespace
}  // namespace palpate::realtime
