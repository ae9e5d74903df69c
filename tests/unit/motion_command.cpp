// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate make-motion` as a process, on small models baked for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"

namespace palpate {
namespace {

struct Pair {
  const char* motion;
  const char* tool;
  const char* other;
  const char* triangles;
  double delta_m;
};

// Tolerances above the clearance of parts that interlock. A screw turns in its nut from 20,000
// triangles on, which take too long to bake here.
constexpr Pair kPairs[] = {
    {"ellipsoid", "ellipsoid", "ellipsoid", "500", 0.0005},
    {"ball_joint", "ball_joint_head", "ball_joint_cup", "1000", 0.0005},
    {"ball_shell", "golf_ball", "golf_shell", "1000", 0.0005},
};

std::vector<std::string> column(const std::string& csv, std::size_t index) {
  std::vector<std::string> out;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string field;
    for (std::size_t i = 0; i <= index; ++i) std::getline(fields, field, ',');
    out.push_back(field);
  }
  if (!out.empty()) out.erase(out.begin());  // the header
  return out;
}

/// The models and scene of a pair, and what is made from them.
class Workshop {
 public:
  explicit Workshop(const Pair& pair) : pair_(pair) {
    for (const char* model : {pair.tool, pair.other}) {
      expect_done({"make-model", model, "--triangles", pair.triangles, "-o", at("mesh.ply")});
      expect_done({"bake", at("mesh.ply"), "-o", at(model) + ".palp", "--engine", "regions"});
    }
    folder_.write(
        "scene.toml",
        "[engine]\nengine = \"regions\"\nexact = true\ndelta_m = " + std::to_string(pair.delta_m) +
            "\n[[body]]\nname = \"tool\"\nrole = \"tool\"\nimage = \"" + pair.tool +
            ".palp\"\n[[body]]\nname = \"other\"\nimage = \"" + pair.other + ".palp\"\n");
  }

  [[nodiscard]] std::string poses(const std::vector<std::string>& more) const {
    std::vector<std::string> command = {"make-motion", pair_.motion, at("scene.toml"), "-o",
                                        at("poses.csv")};
    command.insert(command.end(), more.begin(), more.end());
    expect_done(command);
    return test::read_file(at("poses.csv"));
  }

  /// Of the poses that were made last.
  [[nodiscard]] std::string ticks() const {
    expect_done({"replay", at("scene.toml"), "--poses", at("poses.csv"), "-o", at("ticks.csv")});
    return test::read_file(at("ticks.csv"));
  }

 private:
  [[nodiscard]] std::string at(const std::string& name) const { return folder_.path() / name; }

  static void expect_done(std::vector<std::string> command) {
    command.insert(command.begin(), PALPATE_EXECUTABLE);
    command.push_back("--quiet");
    const test::Outcome outcome = test::run(command);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }

  Pair pair_;
  test::TemporaryFolder folder_;
};

class MakeMotion : public ::testing::TestWithParam<Pair> {};

TEST_P(MakeMotion, Gaps_run_from_slightly_below_touch_to_within_the_tolerance) {
  const Workshop workshop(GetParam());
  ASSERT_FALSE(workshop.poses({"--ticks", "40"}).empty());
  double least_m = 1;
  std::size_t apart = 0, overlapping = 0;
  for (const std::string& gap : column(workshop.ticks(), 10)) {
    if (gap.empty()) continue;
    const double gap_m = std::strtod(gap.c_str(), nullptr);
    least_m = std::min(least_m, gap_m);
    (gap_m > 0 ? apart : overlapping) += 1;
  }
  EXPECT_GT(least_m, -0.15 * GetParam().delta_m);
  EXPECT_GT(apart, 20u);
  EXPECT_GT(overlapping, 2u);
}

INSTANTIATE_TEST_SUITE_P(Pairs, MakeMotion, ::testing::ValuesIn(kPairs),
                         [](const auto& param) { return std::string(param.param.motion); });

TEST(MotionSample, Stretches_of_ten_ticks_have_their_own_times) {
  const std::string poses = Workshop(kPairs[0]).poses({"--ticks", "60", "--one-in", "3"});
  const std::vector<std::string> t = column(poses, 0);
  ASSERT_EQ(t.size(), 20u);
  EXPECT_EQ(t[0], "0.000");
  EXPECT_EQ(t[9], "0.009");
  EXPECT_EQ(t[10], "0.030");
  EXPECT_EQ(t[19], "0.039");
}

}  // namespace
}  // namespace palpate
