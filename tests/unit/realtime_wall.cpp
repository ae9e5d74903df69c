// SPDX-License-Identifier: GPL-3.0-or-later
// The closed loop of hand and contact in virtual time, with a wall for the contact engine.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/poses.hpp"
#include "tests/support/virtual_loop.hpp"

namespace palpate::realtime {
namespace {

using palpate::test::at_z;
using test::VirtualLoop;
using test::wall;

/// Presses 5 mm into the wall and stays there.
hal::mock::HandParameters pressing_hand() {
  hal::mock::HandParameters hand;
  hand.script = {{0, at_z(0.01)}, {0.5, at_z(-0.005)}, {1000, at_z(-0.005)}};
  return hand;
}

LoopSettings for_seconds(double seconds) {
  LoopSettings settings;
  settings.periods = static_cast<std::uint64_t>(seconds * settings.rate_Hz);
  return settings;
}

TEST(ClosedLoop, pressing_hand_comes_to_rest_where_grip_and_wall_balance) {
  VirtualLoop rig(pressing_hand(), for_seconds(4), wall(600));
  const LoopReport& r = rig.run();
  const auto records = rig.records();
  ASSERT_EQ(records.size(), 4000u);
  const double rest_m = -0.005 * 300.0 / (300.0 + 600.0);
  for (std::size_t i = 3500; i < records.size(); ++i) {
    ASSERT_NEAR(records[i].position_m[2], rest_m, 1e-6);
    ASSERT_NEAR(records[i].rendered_force_N[2], -600 * rest_m, 1e-3);
    ASSERT_NEAR(static_cast<double>(records[i].sent_force_N[2]), -600 * rest_m, 1e-3);
  }
  EXPECT_EQ(r.state, LoopState::rendering);
  EXPECT_NEAR(static_cast<double>(r.contacts), 4000 - 333, 40);
}

TEST(ClosedLoop, at_modest_stiffness_the_wall_gives_out_no_energy) {
  VirtualLoop rig(pressing_hand(), for_seconds(4), wall(600));
  const LoopReport& r = rig.run();
  // At rest in the wall the hand's work is what the spring holds: k x^2 / 2, within what sampling
  // adds.
  const double stored_J = 0.5 * 600 * std::pow(0.005 / 3, 2);
  EXPECT_NEAR(r.energy_J, stored_J, 0.05 * stored_J);
  EXPECT_GE(r.energy_J_min, -1e-9);
}

TEST(ClosedLoop, far_beyond_the_stable_stiffness_energy_shows_it) {
  // Colgate and Schenkel, 1994: passive only where b > K T / 2. Here K T / 2 = 50 N s/m against b
  // = 5.
  hal::mock::HandParameters hand = pressing_hand();
  VirtualLoop rig(hand, for_seconds(4), wall(100'000));
  const LoopReport& r = rig.run();
  EXPECT_LT(r.energy_J_min, -1e-3);
}

TEST(ClosedLoop, force_limit_holds_however_hard_the_wall) {
  LoopSettings settings = for_seconds(4);
  settings.safety.max_force_N = 3;
  VirtualLoop rig(pressing_hand(), settings, wall(100'000));
  EXPECT_LE(rig.run().force_N_max, 3.0);
}

TEST(ClosedLoop, arming_inside_the_wall_starts_gently) {
  hal::mock::HandParameters hand;
  hand.rest = at_z(-0.005);
  VirtualLoop rig(hand, for_seconds(2), wall(600));
  rig.run();
  const auto records = rig.records();
  double steepest_N = 0;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const double change = static_cast<double>(records[i].sent_force_N[2]) -
                          static_cast<double>(records[i - 1].sent_force_N[2]);
    steepest_N = std::max(steepest_N, std::abs(change));
  }
  EXPECT_LE(steepest_N, 3.0 * 1e-3 / 0.2 * 1.01);  // 600 N/m x 5 mm over the ramp of 0.2 s
}

TEST(ClosedLoop, repeated_in_virtual_time_gives_the_same_bytes) {
  std::vector<TraceRecord> records[2];
  for (auto& out : records) {
    VirtualLoop rig(pressing_hand(), for_seconds(2), wall(900));
    rig.run();
    out = rig.records();
  }
  ASSERT_EQ(records[0].size(), records[1].size());
  EXPECT_EQ(
      std::memcmp(records[0].data(), records[1].data(), records[0].size() * sizeof(TraceRecord)),
      0);
}

}  // namespace
}  // namespace palpate::realtime
