// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate sweep` and `palpate make-motion` as processes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/cube_scene.hpp"
#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"

namespace palpate {
namespace {

class Sweep : public ::testing::Test {
 protected:
  Sweep() {
    folder_.write("cube.palp", test::cube_image());
    folder_.write("scene.toml", test::cube_scene());
    write_poses(0.0002);
  }

  void write_poses(double step_m) {
    folder_.write("poses.csv", test::cube_poses(kTicks, 0.0008, step_m));
  }

  [[nodiscard]] std::string at(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  test::Outcome sweep(const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {PALPATE_EXECUTABLE, "sweep",         at("scene.toml"),
                                        "--poses",          at("poses.csv"), "-o",
                                        at("out"),          "--engine",      "levels"};
    command.insert(command.end(), more.begin(), more.end());
    return test::run(command);
  }

  static std::size_t files(const std::filesystem::path& folder) {
    std::size_t n = 0;
    for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder)) ++n;
    return n;
  }

  void expect_refusal(const test::Outcome& outcome, int status, const std::string& what) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.err.find("palpate: error: "), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
  }

  static constexpr int kTicks = 5;
  test::TemporaryFolder folder_;
};

TEST_F(Sweep, Table_has_a_row_a_setting_and_the_exact_ones) {
  const test::Outcome outcome = sweep({"--s0", "0.01,0.5", "--json", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(rows, nlohmann::json::parse(test::read_file(at("out/sweep.json"))));
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) {
    EXPECT_EQ(row["engine"], "levels");
    EXPECT_EQ(row["ticks"], kTicks);
    EXPECT_EQ(row["timed_ticks"], kTicks);
    EXPECT_EQ(row["certificates_broken"], 0);
    EXPECT_GT(row["median_ns"], 0);
    EXPECT_GE(row["max_ns"], row["p99_ns"]);
    EXPECT_TRUE(row["budget_us"].is_null());
    EXPECT_TRUE(std::filesystem::exists(at("out/ticks/" + row["id"].get<std::string>() + ".csv")));
  }
  EXPECT_TRUE(rows[0]["exact"]);
  EXPECT_EQ(rows[0]["force_nrmse"], 0);
  EXPECT_TRUE(rows[0]["s0"].is_null());
  EXPECT_EQ(rows[1]["bounds"], "paper");
  EXPECT_EQ(rows[1]["speedup_median"], 1);
  EXPECT_EQ(rows[3]["s0"], 0.5);
  const std::string csv = test::read_file(at("out/sweep.csv"));
  EXPECT_EQ(csv.find("id,engine,exact,s0,kappa,"), 0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_EQ(test::read_file(at("out/trade.svg")).find("<svg"), 0u);
  EXPECT_EQ(test::read_file(at("out/profile.svg")).find("<svg"), 0u);
}

TEST_F(Sweep, Finished_settings_are_not_replayed_again) {
  ASSERT_EQ(sweep({"--s0", "0.01", "--quiet"}).status, 0);
  const std::string exact = at("out/ticks/levels-exact-delta_5e-04.csv");
  const std::string before = test::read_file(exact);
  std::filesystem::remove(at("out/ticks/levels-s0_0.01-delta_5e-04.csv"));
  std::filesystem::remove(at("out/sweep.json"));
  ASSERT_EQ(sweep({"--s0", "0.01,0.2", "--quiet"}).status, 0);
  EXPECT_EQ(test::read_file(exact), before);  // times included
  EXPECT_EQ(files(at("out/ticks")), 4u);
  ASSERT_EQ(sweep({"--s0", "0.7", "--quiet"}).status, 0);  // the table keeps what was there
  EXPECT_EQ(nlohmann::json::parse(test::read_file(at("out/sweep.json"))).size(), 5u);
}

TEST_F(Sweep, Setting_cut_short_is_done_again) {
  ASSERT_EQ(sweep({"--s0", "0.01", "--quiet"}).status, 0);
  const std::string file = at("out/ticks/levels-s0_0.01-delta_5e-04.csv");
  const std::string whole = test::read_file(file);
  folder_.write("out/ticks/levels-s0_0.01-delta_5e-04.csv", whole.substr(0, whole.size() / 2));
  ASSERT_EQ(sweep({"--s0", "0.01", "--quiet"}).status, 0);
  const std::string again = test::read_file(file);
  EXPECT_EQ(std::count(again.begin(), again.end(), '\n'), kTicks + 1);
}

TEST_F(Sweep, Ticks_beyond_the_timed_ones_have_answers_without_times) {
  const test::Outcome outcome =
      sweep({"--s0", "0.01", "--timed-ticks", "2", "--threads", "2", "--json", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const auto& row : nlohmann::json::parse(outcome.out)) {
    EXPECT_EQ(row["ticks"], kTicks);
    EXPECT_EQ(row["timed_ticks"], 2);
  }
  ASSERT_EQ(sweep({"--s0", "0.01", "--timed-ticks", "2", "--quiet"}).status, 0);
}

TEST_F(Sweep, Other_motion_in_the_same_folder_exits_2) {
  ASSERT_EQ(sweep({"--s0", "0.01", "--quiet"}).status, 0);
  write_poses(0.0001);
  expect_refusal(sweep({"--s0", "0.01"}), 2, "another scene, motion, images or clock");
}

TEST_F(Sweep, Processor_time_is_another_sweep) {
  ASSERT_EQ(sweep({"--s0", "0.01", "--quiet", "--processor-time"}).status, 0);
  expect_refusal(sweep({"--s0", "0.01"}), 2, "or clock");
}

TEST_F(Sweep, Advice_fits_the_budget_and_its_scene_replays) {
  const test::Outcome outcome =
      sweep({"--s0", "0.01", "--recommend", "--budget-us", "1e6", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("Within 1e+06 µs on this machine: levels"), 0u) << outcome.out;
  const test::Outcome replay =
      test::run({PALPATE_EXECUTABLE, "replay", at("out/recommended.toml"), "--poses",
                 at("poses.csv"), "-o", at("ticks.csv"), "--quiet"});
  EXPECT_EQ(replay.status, 0) << replay.err;
}

TEST_F(Sweep, Recommended_scene_keeps_comments_and_numbers) {
  folder_.write("scene.toml",
                "# ours\n" + test::cube_scene("kappa = 1  # gone\nbudget_us = 400\n# a word\n"));
  ASSERT_EQ(
      sweep({"--s0", "0.01", "--kappa", "inf", "--recommend", "--budget-us", "1e6", "--quiet"})
          .status,
      0);
  const std::string scene = test::read_file(at("out/recommended.toml"));
  EXPECT_EQ(scene.find("# ours\n[engine]\n"), 0u) << scene;
  EXPECT_NE(scene.find("delta_m = 0.0005\n"), std::string::npos) << scene;
  EXPECT_NE(scene.find("\n# a word\n"), std::string::npos) << scene;
  EXPECT_NE(scene.find("image = \"../cube.palp\""), std::string::npos) << scene;
  EXPECT_EQ(scene.find("kappa"), std::string::npos) << scene;
  EXPECT_EQ(scene.find("budget_us = 400"), std::string::npos) << scene;
}

TEST_F(Sweep, Recommended_scene_of_dotted_keys_is_written_anew) {
  std::string text = test::cube_scene();
  text.replace(text.find("[engine]\n"), 9, "engine.");
  folder_.write("scene.toml", text);
  ASSERT_EQ(sweep({"--s0", "0.01", "--recommend", "--budget-us", "1e6", "--quiet"}).status, 0);
  const test::Outcome replay =
      test::run({PALPATE_EXECUTABLE, "replay", at("out/recommended.toml"), "--poses",
                 at("poses.csv"), "-o", at("ticks.csv"), "--quiet"});
  EXPECT_EQ(replay.status, 0) << replay.err;
}

/// Without the levels engine there is no speed-up to tell.
TEST_F(Sweep, Table_has_no_number_where_there_is_nothing_to_compare_with) {
  folder_.write("cube.palp", test::read_file(PALPATE_TEST_DATA "/bumpy_ball_regions.bin"));
  folder_.write("scene.toml", test::cube_scene("engine = \"regions\"\n"));
  folder_.write("poses.csv",
                "t,body,px,py,pz,qw,qx,qy,qz\n0,tool,1.95,0,0,1,0,0,0\n1,tool,1.94,0,0,1,0,0,0\n");
  const test::Outcome outcome =
      test::run({PALPATE_EXECUTABLE, "sweep", at("scene.toml"), "--poses", at("poses.csv"), "-o",
                 at("out"), "--engine", "regions"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("median µs"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
}

TEST_F(Sweep, Scene_and_folder_of_the_current_folder_are_enough) {
  const test::Outcome outcome =
      test::run_in(folder_.path(), {PALPATE_EXECUTABLE, "sweep", "scene.toml", "--poses",
                                    "poses.csv", "-o", "out/", "--engine", "levels", "--s0", "0.01",
                                    "--recommend", "--budget-us", "1e6", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const test::Outcome replay =
      test::run_in(folder_.path(), {PALPATE_EXECUTABLE, "replay", "out/recommended.toml", "--poses",
                                    "poses.csv", "-o", "ticks.csv", "--quiet"});
  EXPECT_EQ(replay.status, 0) << replay.err;
}

TEST_F(Sweep, Advice_that_nothing_fits_exits_1) {
  const test::Outcome outcome =
      sweep({"--s0", "0.01", "--recommend", "--budget-us", "0", "--quiet"});
  expect_refusal(outcome, 1, "no setting's p99.9 fits");
  EXPECT_FALSE(std::filesystem::exists(at("out/recommended.toml")));
}

TEST_F(Sweep, Wrong_options_exit_2_and_leave_no_folder) {
  expect_refusal(sweep({"--s0", "-1"}), 2, "--s0");
  expect_refusal(sweep({"--s0", "0.1,nan"}), 2, "--s0");
  expect_refusal(sweep({"--kappa", "x"}), 2, "--kappa");
  expect_refusal(sweep({"--engine", "other"}), 2, "--engine");
  expect_refusal(sweep({"--timed-ticks", "0"}), 2, "--timed-ticks");
  expect_refusal(sweep({"--recommend"}), 2, "advice needs one budget");
  expect_refusal(sweep({"--recommend", "--budget-us", "1,2"}), 2, "advice needs one budget");
  EXPECT_FALSE(std::filesystem::exists(at("out")));
}

TEST_F(Sweep, Refused_input_exits_3) {
  folder_.write("poses.csv", "t,body,px,py,pz,qw,qx,qy,qz\n0,tool,nan,0,0,1,0,0,0\n");
  expect_refusal(sweep(), 3, "poses.csv:2: ");
  write_poses(0.0002);
  folder_.write("cube.palp", "no image");
  expect_refusal(sweep(), 3, "cube.palp");
  EXPECT_FALSE(std::filesystem::exists(at("out")));
}

TEST_F(Sweep, Image_without_regions_is_refused_where_they_are_asked_for) {
  expect_refusal(sweep({"--engine", "regions", "--quiet"}), 3, "the engine refuses the scene");
  const test::Outcome motion = test::run({PALPATE_EXECUTABLE, "make-motion", "jaws",
                                          at("scene.toml"), "-o", at("motion.csv"), "--quiet"});
  expect_refusal(motion, 3, "the engine refuses the scene");
  EXPECT_FALSE(std::filesystem::exists(at("motion.csv")));
}

TEST_F(Sweep, Unknown_motion_exits_2) {
  const test::Outcome motion = test::run(
      {PALPATE_EXECUTABLE, "make-motion", "dance", at("scene.toml"), "-o", at("motion.csv")});
  expect_refusal(motion, 2, "unknown motion");
}

}  // namespace
}  // namespace palpate
