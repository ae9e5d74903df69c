// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/stable_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::cli {
namespace {

config::Scene scene_of(double stiffness_N_per_m, config::Coupling coupling) {
  config::Scene scene;
  scene.settings.stiffness_N_per_m = scene.virtual_tool.spring_N_per_m = stiffness_N_per_m;
  scene.coupling = coupling;
  return scene;
}

TEST(StableScene, that_a_device_can_take_stays) {
  const StableScene s = stable_scene(scene_of(600, config::Coupling::direct), 1000, 5);
  EXPECT_EQ(s.note, "");
  EXPECT_EQ(s.scene.settings.stiffness_N_per_m, 600);
  EXPECT_TRUE(std::isinf(s.scene.settings.max_force_N));  // the safety stage's business
}

TEST(StableScene, that_is_too_stiff_is_lowered_and_says_so) {
  const StableScene s = stable_scene(scene_of(1e5, config::Coupling::direct), 1000, 3);
  EXPECT_NEAR(s.scene.settings.stiffness_N_per_m, 0.5 * 3 / 0.0015, 1e-9);
  EXPECT_NE(s.note.find("stiffness_N_per_m lowered from 1e+05 to 1000"), std::string::npos)
      << s.note;
  EXPECT_NE(s.note.find("device_damping_N_s_per_m"), std::string::npos);
}

TEST(StableScene, that_damps_its_contacts_can_take_less) {
  config::Scene scene = scene_of(1e5, config::Coupling::direct);
  scene.contact_damping_N_s_per_m = 1;
  const StableScene s = stable_scene(scene, 1000, 3);
  EXPECT_NEAR(s.scene.settings.stiffness_N_per_m, 0.5 * (3 - 2) / 0.0015, 1e-9);
}

TEST(StableScene, of_unknown_damping_stays) {
  EXPECT_EQ(stable_scene(scene_of(1e9, config::Coupling::direct), 1000, {}).note, "");
}

TEST(StableScene, that_is_coupled_has_its_spring_lowered_and_its_contacts_not_limited) {
  const StableScene s = stable_scene(scene_of(1e5, config::Coupling::virtual_), 1000, 3);
  EXPECT_NEAR(s.scene.virtual_tool.spring_N_per_m, 2000, 1e-9);
  EXPECT_EQ(s.scene.settings.stiffness_N_per_m, 1e5);
  EXPECT_TRUE(std::isinf(s.scene.settings.max_force_N));
  EXPECT_NE(s.note.find("spring_N_per_m"), std::string::npos);
}

}  // namespace
}  // namespace palpate::cli
