// SPDX-License-Identifier: Apache-2.0
// The files that lie in config/: the reference and the example scenes.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/temporary_folder.hpp"
#include "config/scene.hpp"
#include "config/scene_keys.hpp"

namespace palpate::config {
namespace {

const std::filesystem::path kConfig = PALPATE_CONFIG_FOLDER;

TEST(ConfigReadme, Holds_the_table_of_keys) {
  const std::string readme = test::read_file(kConfig / "README.md");
  EXPECT_NE(readme.find(key_tables()), std::string::npos)
      << "config/README.md has to hold exactly this:\n"
      << key_tables();
}

class ExampleScene : public ::testing::TestWithParam<const char*> {};

TEST_P(ExampleScene, Loads_with_a_path_that_closes) {
  const Scene scene = load_scene(kConfig / "scenes" / GetParam());
  ASSERT_GE(scene.hand.path.size(), 2u);
  // Ends where it starts: it is repeated.
  const Pose& first = scene.hand.path.front().pose;
  const Pose& last = scene.hand.path.back().pose;
  EXPECT_EQ(first.position_m, last.position_m);
  EXPECT_EQ(first.orientation.w, last.orientation.w);
  EXPECT_TRUE(std::isfinite(scene.settings.max_force_N));
}

INSTANTIATE_TEST_SUITE_P(All, ExampleScene,
                         ::testing::Values("jaws.toml", "golf.toml", "ball_joint.toml",
                                           "ellipsoid_golf.toml", "golf_balls.toml",
                                           "ball_shell.toml", "screw_nut.toml"));

}  // namespace
}  // namespace palpate::config
