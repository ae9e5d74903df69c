// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/path.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "hal/rotation.hpp"
#include "tests/support/poses.hpp"

namespace palpate::hal::mock {
namespace {

using palpate::test::at_x;

TEST(Path, empty_script_stays_at_rest) {
  const Path path({}, at_x(0.25));
  EXPECT_EQ(path.at(0).pose.position_m.x, 0.25);
  EXPECT_EQ(path.at(1e6).pose.position_m.x, 0.25);
  EXPECT_EQ(norm(path.at(3).twist.linear_m_per_s), 0.0);
}

TEST(Path, one_waypoint_stays_there) {
  const std::array<Waypoint, 1> script{{{0, at_x(0.5)}}};
  EXPECT_EQ(Path(script, at_x(0)).at(17).pose.position_m.x, 0.5);
}

TEST(Path, between_waypoints_moves_at_constant_velocity) {
  const std::array<Waypoint, 3> script{{{0, at_x(0)}, {1, at_x(0.2)}, {3, at_x(0)}}};
  const Path path(script, {});
  EXPECT_NEAR(path.at(0.5).pose.position_m.x, 0.1, 1e-15);
  EXPECT_NEAR(path.at(0.5).twist.linear_m_per_s.x, 0.2, 1e-15);
  EXPECT_NEAR(path.at(2.0).pose.position_m.x, 0.1, 1e-15);
  EXPECT_NEAR(path.at(2.0).twist.linear_m_per_s.x, -0.1, 1e-15);
}

TEST(Path, after_its_end_starts_again) {
  const std::array<Waypoint, 2> script{{{0, at_x(0)}, {2, at_x(1)}}};
  const Path path(script, {});
  EXPECT_NEAR(path.at(2.5).pose.position_m.x, path.at(0.5).pose.position_m.x, 1e-15);
  EXPECT_NEAR(path.at(2000.5).pose.position_m.x, 0.25, 1e-9);
}

TEST(Path, orientation_turns_at_constant_rate_the_short_way) {
  std::array<Waypoint, 2> script{};
  script[1].t_s = 2;
  const Quat quarter = rotation_from_vector({0, 0, 1.5});
  script[1].pose.orientation = {-quarter.w, -quarter.x, -quarter.y, -quarter.z};
  const Path path(script, {});
  const Target middle = path.at(0.5);
  EXPECT_NEAR(vector_from_rotation(middle.pose.orientation).z, 0.375, 1e-14);
  EXPECT_NEAR(middle.twist.angular_rad_per_s.z, 0.75, 1e-14);
}

TEST(Path, bad_scripts_are_told_apart_from_good_ones) {
  using Script = std::vector<Waypoint>;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(Path::is_valid(Script{}));
  EXPECT_TRUE(Path::is_valid(Script{{0, {}}, {1, {}}}));
  EXPECT_FALSE(Path::is_valid(Script{{0.5, {}}}));
  EXPECT_FALSE(Path::is_valid(Script{{0, {}}, {1, {}}, {1, {}}}));
  EXPECT_FALSE(Path::is_valid(Script{{0, {}}, {kNan, {}}}));
  EXPECT_FALSE(Path::is_valid(Script{{0, at_x(kNan)}}));
}

}  // namespace
}  // namespace palpate::hal::mock
