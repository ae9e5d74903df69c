// SPDX-License-Identifier: GPL-3.0-or-later
// At and below the stiffness that `palpate run` allows, a pressed wall comes to rest, whatever the
// hand, the rate and the encoder.
#include <gtest/gtest.h>

#include "tests/support/effort.hpp"
#include "tools/bench/pressed_wall.hpp"
#include "tools/palpate/stable_scene.hpp"

namespace palpate::bench {
namespace {

/// What a scene that asks for far too much is lowered to.
double allowed_N_per_m(const PressedWall& w) {
  config::Scene scene;
  scene.coupling = w.felt == Felt::direct ? config::Coupling::direct : config::Coupling::virtual_;
  scene.settings.stiffness_N_per_m = scene.virtual_tool.spring_N_per_m = 1e9;
  const cli::StableScene stable = cli::stable_scene(scene, w.rate_Hz, w.damping_N_s_per_m);
  return w.felt == Felt::direct ? stable.scene.settings.stiffness_N_per_m
                                : stable.scene.virtual_tool.spring_N_per_m;
}

class AllowedStiffness : public testing::TestWithParam<Felt> {};

TEST_P(AllowedStiffness, has_no_limit_cycle) {
  int cases = 0;
  for (const double rate_Hz : {500.0, 1000.0, 2000.0, 4000.0, 10000.0})
    for (const double damping : {0.5, 2.0, 5.0})
      for (const double mass_kg : {0.1, 0.3, 1.0})
        for (const double grip : {10.0, 1000.0})
          for (const int bits : {16, 20}) {
            if (++cases % test::effort(1, 12) != 0) continue;
            PressedWall w{mass_kg, damping, grip, rate_Hz, bits, GetParam(), false, 0};
            // The allowed one, and less than it.
            w.stiffness_N_per_m = (cases % 3 == 0 ? 0.3 : 1.0) * allowed_N_per_m(w);
            EXPECT_TRUE(comes_to_rest(w))
                << rate_Hz << " Hz, " << damping << " N s/m, " << mass_kg << " kg, " << grip
                << " N/m, " << bits << " bits, " << w.stiffness_N_per_m << " N/m";
          }
  EXPECT_EQ(cases, 180);
}

INSTANTIATE_TEST_SUITE_P(Couplings, AllowedStiffness, testing::Values(Felt::direct, Felt::coupled),
                         [](const auto& tested) {
                           return tested.param == Felt::direct ? "direct" : "virtual";
                         });

TEST(PressedWallMap, largest_stiffness_of_a_light_hand_is_the_bound) {
  for (const double rate_Hz : {500.0, 1000.0, 4000.0}) {
    const PressedWall w{0.1, 2, 1000, rate_Hz, 20, Felt::direct, false, 0};
    EXPECT_NEAR(largest_stable_stiffness(w), passive_stiffness(w), 0.2 * passive_stiffness(w));
  }
}

TEST(PressedWallMap, far_beyond_the_bound_does_not_rest) {
  PressedWall w;
  w.stiffness_N_per_m = 5 * passive_stiffness(w);
  EXPECT_FALSE(comes_to_rest(w));
}

}  // namespace
}  // namespace palpate::bench
