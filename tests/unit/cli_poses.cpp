// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/poses.hpp"

#include <gtest/gtest.h>

#include <string>

#include "../support/temporary_folder.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

const std::string kHeader = std::string(kPosesHeader) + "\n";

class Poses : public ::testing::Test {
 protected:
  Poses() {
    scene_.file = "scene.toml";
    scene_.bodies.resize(3);
    scene_.bodies[0].name = "tool";
    scene_.bodies[0].role = config::Role::tool;
    scene_.bodies[1].name = "wall";
    scene_.bodies[2].name = "arm";
    scene_.bodies[2].role = config::Role::moved;
  }

  PoseTrack read(const std::string& text) {
    return read_poses(folder_.write("poses.csv", text), scene_);
  }

  void expect_refusal(const std::string& text, const std::string& what, int line) {
    try {
      read(text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Failure& e) {
      const std::string message = e.what();
      EXPECT_EQ(e.code, kRefused);
      EXPECT_EQ(message.find(what), 0u) << message;
      EXPECT_NE(message.find("poses.csv:" + std::to_string(line) + ": "), std::string::npos)
          << message;
    }
  }

  config::Scene scene_;
  test::TemporaryFolder folder_;
};

TEST_F(Poses, Rows_of_one_time_make_one_tick) {
  const PoseTrack track = read(kHeader +
                               "0,tool,1,2,3,1,0,0,0\n"
                               "0,arm,4,5,6,0,1,0,0\n"
                               "0.001,tool,-1.5e-3,0,0,0.6,0,0.8,0\n");
  ASSERT_EQ(track.ticks.size(), 2u);
  EXPECT_EQ(track.ticks[0].changes, 2u);
  EXPECT_EQ(track.ticks[1].t_s, 0.001);
  ASSERT_EQ(track.changes.size(), 3u);
  EXPECT_EQ(track.changes[1].body, 2u);
  EXPECT_EQ(track.changes[1].pose.position_m.y, 5.0);
  EXPECT_EQ(track.changes[1].pose.orientation.x, 1.0);
  EXPECT_EQ(track.changes[2].pose.position_m.x, -0.0015);
  EXPECT_DOUBLE_EQ(track.changes[2].pose.orientation.y, 0.8);
}

TEST_F(Poses, Body_without_a_row_keeps_its_pose) {
  const PoseTrack track =
      read(kHeader + "0,tool,1,0,0,1,0,0,0\n0,arm,2,0,0,1,0,0,0\n1,arm,3,0,0,1,0,0,0\n");
  std::vector<Pose> poses(3);
  poses[1].position_m.x = 9;
  track.apply(0, poses);
  track.apply(1, poses);
  EXPECT_EQ(poses[0].position_m.x, 1.0);
  EXPECT_EQ(poses[1].position_m.x, 9.0);
  EXPECT_EQ(poses[2].position_m.x, 3.0);
}

TEST_F(Poses, Crlf_blanks_and_no_last_newline_are_read) {
  const PoseTrack track =
      read(std::string(kPosesHeader) + "\r\n0, tool ,1,2,3,1,0,0,0\r\n\r\n1,tool,1,2,3,1,0,0,0");
  EXPECT_EQ(track.ticks.size(), 2u);
}

TEST_F(Poses, Quaternion_a_little_off_is_normalised) {
  const PoseTrack track = read(kHeader + "0,tool,0,0,0,1.0005,0,0,0\n");
  EXPECT_EQ(track.changes[0].pose.orientation.w, 1.0);
}

TEST_F(Poses, Quaternion_off_or_zero_is_refused) {
  expect_refusal(kHeader + "0,tool,0,0,0,0,0,0,0\n", "not a unit quaternion", 2);
  expect_refusal(kHeader + "0,tool,0,0,0,1.002,0,0,0\n", "not a unit quaternion", 2);
  expect_refusal(kHeader + "0,tool,0,0,0,1e200,0,0,0\n", "not a unit quaternion", 2);
}

TEST_F(Poses, Number_that_is_none_or_not_finite_is_refused) {
  expect_refusal(kHeader + "0,tool,0,0,0,1,0,0,0\n1,tool,nan,0,0,1,0,0,0\n",
                 "px = nan is not finite", 3);
  expect_refusal(kHeader + "0,tool,0,0,0,1,0,0,inf\n", "qz = inf is not finite", 2);
  expect_refusal(kHeader + "0,tool,0,1e999,0,1,0,0,0\n", "py = 1e999 is not finite", 2);
  expect_refusal(kHeader + "nan,tool,0,0,0,1,0,0,0\n", "t = nan is not finite", 2);
  expect_refusal(kHeader + "0,tool,0,0,x,1,0,0,0\n", "pz = 'x' is no number", 2);
  expect_refusal(kHeader + "0,tool,0,0,1.0.0,1,0,0,0\n", "pz = '1.0.0' is no number", 2);
  expect_refusal(kHeader + "0,tool,0,,0,1,0,0,0\n", "py = '' is no number", 2);
  expect_refusal(kHeader + "0,tool,0,2e12,0,1,0,0,0\n", "py = 2e+12 is out of range", 2);
}

TEST_F(Poses, Time_running_backwards_is_refused) {
  expect_refusal(kHeader + "1,tool,0,0,0,1,0,0,0\n0.5,tool,0,0,0,1,0,0,0\n", "time runs backwards",
                 3);
}

TEST_F(Poses, Body_unknown_or_fixed_or_twice_is_refused) {
  expect_refusal(kHeader + "0,hand,0,0,0,1,0,0,0\n", "no body is named 'hand'", 2);
  expect_refusal(kHeader + "0,wall,0,0,0,1,0,0,0\n", "body 'wall' is fixed", 2);
  expect_refusal(kHeader + "0,tool,0,0,0,1,0,0,0\n0,tool,0,0,0,1,0,0,0\n",
                 "body 'tool' a second time", 3);
}

TEST_F(Poses, Wrong_shape_is_refused) {
  expect_refusal("", "no poses", 0);
  expect_refusal(kHeader, "no poses", 1);
  expect_refusal("t,body,x,y,z,qw,qx,qy,qz\n", "another header", 1);
  expect_refusal(kHeader + "0,tool,0,0,0,1,0,0\n", "8 fields", 2);
  expect_refusal(kHeader + "0,tool,0,0,0,1,0,0,0,0\n", "10 fields", 2);
  expect_refusal(kHeader + "0,tool,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0\n", "19 fields", 2);
}

TEST_F(Poses, Unreadable_file_is_refused) {
  EXPECT_THROW(read_poses(folder_.path() / "absent.csv", scene_), Failure);
  EXPECT_THROW(read_poses(folder_.path(), scene_), Failure);
}

}  // namespace
}  // namespace palpate::cli
