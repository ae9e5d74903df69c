// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace palpate::cli {
namespace {

SweepAxes axes() {
  SweepAxes a;
  a.engines = {EngineKind::levels, EngineKind::regions};
  a.s0 = {0.01, 0.05};
  a.kappa = {kNoLimit, 0.1};
  a.force_tolerance_N = {0, 0.5};
  a.budget_us = {kNoLimit, 100};
  a.delta_m = {0.001, 0.002};
  a.bounds = {Bounds::tight};
  return a;
}

TEST(SweepSettings, Combinations_are_all_there_once_after_the_exact_ones) {
  const auto settings = expand(axes());
  // A delta: three exact, 2 * 2 * 2 of levels, 2 * 2 of regions.
  ASSERT_EQ(settings.size(), 2u * (3 + 8 + 4));
  std::set<std::string> ids;
  for (const SweepSetting& s : settings) ids.insert(id_of(s));
  EXPECT_EQ(ids.size(), settings.size());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(settings[i].exact);
  EXPECT_EQ(settings[0].bounds, Bounds::tight);
  EXPECT_EQ(settings[1].bounds, Bounds::paper);
  EXPECT_EQ(settings[2].engine, EngineKind::regions);
}

TEST(SweepSettings, Repeated_values_and_other_engines_add_nothing) {
  SweepAxes a = axes();
  a.engines = {EngineKind::regions};
  a.force_tolerance_N = {0.5, 0.5};
  a.delta_m = {0.001};
  EXPECT_EQ(expand(a).size(), 3u);
}

TEST(SweepSettings, Reference_of_each_is_in_the_sweep) {
  const auto settings = expand(axes());
  for (const SweepSetting& s : settings) {
    const SweepSetting exact = reference_of(s);
    EXPECT_TRUE(exact.exact);
    EXPECT_EQ(exact.delta_m, s.delta_m);
    EXPECT_NE(std::find(settings.begin(), settings.end(), exact), settings.end()) << id_of(s);
  }
}

TEST(SweepSettings, Name_is_fit_for_a_file) {
  for (const SweepSetting& s : expand(axes())) {
    EXPECT_EQ(id_of(s).find_first_not_of(
                  "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-"),
              std::string::npos)
        << id_of(s);
  }
}

TEST(SweepSettings, Scene_gets_the_setting_and_keeps_the_rest) {
  config::Scene scene;
  scene.settings.stiffness_N_per_m = 123;
  scene.kappa = 0.7;
  scene.budget_us = 400;
  scene.reserve_us = 200;
  const config::Scene unlimited = with_setting(scene, {.s0 = 0.3, .delta_m = 0.002});
  EXPECT_FALSE(unlimited.kappa);
  EXPECT_FALSE(unlimited.budget_us);
  EXPECT_FALSE(unlimited.reserve_us);  // a budget in a table is all that a tick has
  EXPECT_EQ(unlimited.settings.s0, 0.3);
  EXPECT_EQ(unlimited.settings.delta_m, 0.002);
  EXPECT_EQ(unlimited.settings.stiffness_N_per_m, 123);
  const config::Scene limited =
      with_setting(scene, {.kappa = 0.2, .budget_us = 50, .delta_m = 0.002});
  EXPECT_EQ(*limited.kappa, 0.2);
  EXPECT_EQ(*limited.budget_us, 50);
}

}  // namespace
}  // namespace palpate::cli
