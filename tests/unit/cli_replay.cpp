// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate replay` as a process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "../support/cube_scene.hpp"
#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"

namespace palpate {
namespace {

constexpr double kDelta_m = 0.0005;
const std::string kTicksHeader =
    "tick,t,fx,fy,fz,tx,ty,tz,contacts,clusters,min_distance,front,queries,time_ns,truncated,s_"
    "worst,error_bound,force_bound";
const std::string kContactsHeader =
    "tick,pair,ax,ay,az,bx,by,bz,nx,ny,nz,distance,piece_a,lod_a,piece_b,lod_b,weight";

std::vector<std::vector<std::string>> rows(const std::string& csv) {
  std::vector<std::vector<std::string>> out;
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);) {
    out.emplace_back();
    std::istringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) out.back().push_back(field);
  }
  return out;
}

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

class Replay : public ::testing::Test {
 protected:
  Replay() {
    folder_.write("cube.palp", test::cube_image());
    folder_.write("scene.toml", test::cube_scene());
    folder_.write("poses.csv", test::cube_poses(kTicks));
  }

  void write_scene(const std::string& engine, const std::string& rest = "",
                   const std::string& force = "") {
    folder_.write("scene.toml", test::cube_scene(engine, rest, force));
  }

  [[nodiscard]] std::string at(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  test::Outcome replay(const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {PALPATE_EXECUTABLE, "replay", at("scene.toml"), "--poses",
                                        at("poses.csv"),    "-o",     at("ticks.csv")};
    command.insert(command.end(), more.begin(), more.end());
    return test::run(command);
  }

  void expect_refusal(const test::Outcome& outcome, int status, const std::string& what) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.err.find("palpate: error: "), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(std::filesystem::exists(at("ticks.csv")));
    EXPECT_EQ(folder_.files(), 3u);  // scene, poses, image: no temporary ones
  }

  static constexpr int kTicks = 6;
  test::TemporaryFolder folder_;
};

TEST_F(Replay, Bodies_that_overlap_in_the_first_tick_are_named) {
  EXPECT_EQ(replay().err.find("overlap"), std::string::npos);
  folder_.write("poses.csv", test::cube_poses(kTicks, -0.0004));
  EXPECT_NE(replay().err.find("'tool' and 'wall' overlap at the start, by 0.0004 m"),
            std::string::npos);
  EXPECT_EQ(replay({"--quiet"}).err, "");
}

TEST_F(Replay, Cubes_approaching_give_distance_and_force) {
  const test::Outcome outcome = replay({"--contacts", at("contacts.csv")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string text = test::read_file(at("ticks.csv"));
  EXPECT_EQ(text.substr(0, text.find('\n')), kTicksHeader);
  const auto ticks = rows(text);
  ASSERT_EQ(ticks.size(), 1u + kTicks);
  std::size_t contacts = 0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const auto& row = ticks[i];
    ASSERT_EQ(row.size(), 18u);
    EXPECT_EQ(row[0], std::to_string(i - 1));
    const double gap_m = 0.001 - 0.0002 * double(i - 1);
    if (gap_m > kDelta_m) {
      EXPECT_EQ(row[10], "");
      EXPECT_EQ(row[8], "0");
      EXPECT_EQ(number(row[2]), 0.0);
    } else {
      EXPECT_NEAR(number(row[10]), gap_m, 1e-8);
      EXPECT_GT(number(row[2]), 0.0);
    }
    EXPECT_EQ(row[14], "0");
    contacts += static_cast<std::size_t>(number(row[8]));
  }

  const std::string contact_text = test::read_file(at("contacts.csv"));
  EXPECT_EQ(contact_text.substr(0, contact_text.find('\n')), kContactsHeader);
  const auto table = rows(contact_text);
  EXPECT_EQ(table.size(), 1 + contacts);
  for (std::size_t i = 1; i < table.size(); ++i) {
    ASSERT_EQ(table[i].size(), 17u);
    EXPECT_NEAR(number(table[i][8]), 1.0, 1e-6);  // from the wall to the tool
    EXPECT_NEAR(number(table[i][2]) - number(table[i][5]), number(table[i][11]), 1e-8);
  }
  EXPECT_EQ(folder_.files(), 6u);
  const auto about = nlohmann::json::parse(test::read_file(at("ticks.about.json")));
  EXPECT_EQ(about.at("poses"), at("poses.csv"));
  EXPECT_TRUE(std::filesystem::exists(about.at("scene").get<std::string>()));
}

TEST_F(Replay, Into_a_pipe_leaves_no_file_beside_it) {
  const test::Outcome outcome =
      test::run({PALPATE_EXECUTABLE, "replay", at("scene.toml"), "--poses", at("poses.csv"), "-o",
                 "/dev/null", "--quiet"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists("/dev/null.about.json"));
}

/// Down on the wall, and along it by 0.05 mm a tick.
constexpr const char* kSliding =
    "t,body,px,py,pz,qw,qx,qy,qz\n0,tool,0.0102,0,0,1,0,0,0\n"
    "0.001,tool,0.0102,0.00005,0,1,0,0,0\n0.002,tool,0.0102,0.0001,0,1,0,0,0\n";

TEST_F(Replay, Friction_of_the_scene_holds_the_tool_and_slips) {
  folder_.write("poses.csv", kSliding);
  write_scene("", "[[pair]]\na = \"tool\"\nb = \"wall\"\nfriction = 0.25\n");
  ASSERT_EQ(replay().status, 0);
  const auto ticks = rows(test::read_file(at("ticks.csv")));
  ASSERT_EQ(ticks.size(), 4u);
  const double pressed_N = 600 * 0.0003;
  EXPECT_NEAR(number(ticks[1][3]), 0, 1e-9);
  EXPECT_NEAR(number(ticks[2][3]), -600 * 0.00005, 1e-6);     // sticks
  EXPECT_NEAR(number(ticks[3][3]), -0.25 * pressed_N, 1e-6);  // slips
  for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_NEAR(number(ticks[i][2]), pressed_N, 1e-6);
}

TEST_F(Replay, Damping_of_the_scene_resists_the_velocity_between_ticks) {
  write_scene("", "[[pair]]\na = \"tool\"\nb = \"wall\"\n");
  ASSERT_EQ(replay().status, 0);
  const auto plain = rows(test::read_file(at("ticks.csv")));
  write_scene("", "[[pair]]\na = \"tool\"\nb = \"wall\"\n", "contact_damping_N_s_per_m = 0.2\n");
  ASSERT_EQ(replay().status, 0);
  const auto damped = rows(test::read_file(at("ticks.csv")));
  ASSERT_EQ(damped.size(), 1u + kTicks);
  // 0.2 m/s into the wall: 0.04 N, at most as much again as the contact's own.
  for (std::size_t i = 1; i < damped.size(); ++i) {
    const double own_N = number(plain[i][2]);
    EXPECT_NEAR(number(damped[i][2]), own_N + std::min(own_N, 0.04), 1e-6);
  }
}

TEST_F(Replay, Limits_hold_for_friction_and_damping_too) {
  folder_.write("poses.csv", kSliding);
  write_scene("", "[[pair]]\na = \"tool\"\nb = \"wall\"\nfriction = 100\n", "max_force_N = 0.1\n");
  ASSERT_EQ(replay().status, 0);
  const auto ticks = rows(test::read_file(at("ticks.csv")));
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    EXPECT_NEAR(std::hypot(number(ticks[i][2]), number(ticks[i][3]), number(ticks[i][4])), 0.1,
                1e-9);
  }
  // Limited together: the direction is that of both.
  EXPECT_NEAR(number(ticks[2][3]) / number(ticks[2][2]), -0.05 / 0.3, 1e-6);
}

TEST_F(Replay, Text_of_numbers_is_the_shortest_that_reads_back) {
  ASSERT_EQ(replay().status, 0);
  for (const auto& row : rows(test::read_file(at("ticks.csv")))) {
    if (row[0] == "tick") continue;
    EXPECT_EQ(row[1], std::stoi(row[0]) == 0 ? "0" : row[1]);
    EXPECT_LE(row[1].size(), 5u) << row[1];
  }
}

TEST_F(Replay, Same_input_gives_the_same_rows_but_for_time) {
  const auto without_time = [&] {
    auto table = rows(test::read_file(at("ticks.csv")));
    for (auto& row : table) row[13].clear();
    return table;
  };
  ASSERT_EQ(replay().status, 0);
  const auto first = without_time();
  ASSERT_EQ(replay({"--repeat", "3"}).status, 0);
  EXPECT_EQ(without_time(), first);
}

TEST_F(Replay, Unit_budget_of_nothing_is_said_to_truncate) {
  ASSERT_EQ(replay({"--budget-units", "0", "--s0", "0"}).status, 0);
  EXPECT_EQ(rows(test::read_file(at("ticks.csv"))).back()[14], "1");
}

TEST_F(Replay, Scene_budget_counts_unless_exact) {
  write_scene("budget_us = 0.0\ns0 = 0.0");
  ASSERT_EQ(replay().status, 0);
  EXPECT_EQ(rows(test::read_file(at("ticks.csv"))).back()[14], "1");
  ASSERT_EQ(replay({"--exact"}).status, 0);
  EXPECT_EQ(rows(test::read_file(at("ticks.csv"))).back()[14], "0");
  ASSERT_EQ(replay({"--exact", "--budget-us", "0"}).status, 0);
  EXPECT_EQ(rows(test::read_file(at("ticks.csv"))).back()[14], "1");
  ASSERT_EQ(replay({"--budget-us", "1e9"}).status, 0);
  EXPECT_EQ(rows(test::read_file(at("ticks.csv"))).back()[14], "0");
}

/// Balls of bumps that touch, and nothing known of them in the first tick.
TEST_F(Replay, Reserve_decides_whether_anything_touches) {
  folder_.write("cube.palp", test::read_file(PALPATE_TEST_DATA "/bumpy_ball_regions.bin"));
  folder_.write("poses.csv", "t,body,px,py,pz,qw,qx,qy,qz\n0,tool,1.95,0,0,1,0,0,0\n");
  write_scene("engine = \"regions\"\nbudget_us = 0.0\nreserve_us = 1e9");
  const auto contacts = [&](const std::vector<std::string>& options) {
    EXPECT_EQ(replay(options).status, 0);
    return number(rows(test::read_file(at("ticks.csv"))).back()[8]);
  };
  EXPECT_GT(contacts({}), 0);
  EXPECT_EQ(contacts({"--budget-units", "0"}), 0);  // in place of all of the scene's
  EXPECT_GT(contacts({"--budget-units", "0", "--reserve-units", "1000000"}), 0);
}

TEST_F(Replay, Room_grows_where_nothing_else_is_limited) {
  write_scene("", "[limits]\nnodes = 1\ncontacts = 1\n");
  ASSERT_EQ(replay({"--exact"}).status, 0);
  const auto grown = rows(test::read_file(at("ticks.csv"))).back();
  write_scene("");
  ASSERT_EQ(replay({"--exact"}).status, 0);
  const auto ample = rows(test::read_file(at("ticks.csv"))).back();
  for (const int same : {2, 3, 4, 8, 9, 10, 14})
    EXPECT_EQ(grown[std::size_t(same)], ample[std::size_t(same)]);
  write_scene("", "[limits]\nnodes = 1\ncontacts = 1\n");
  ASSERT_EQ(replay({"--budget-units", "1000"}).status, 0);
  EXPECT_EQ(rows(test::read_file(at("ticks.csv"))).back()[14], "1");
}

TEST_F(Replay, Summary_is_a_line_or_one_json_object_or_nothing) {
  const std::string line = replay().out;
  EXPECT_EQ(line.find("6 ticks: "), 0u) << line;
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto json = nlohmann::json::parse(replay({"--json", "--quiet"}).out);
  EXPECT_EQ(json["ticks"], 6);
  EXPECT_GE(json["tick_ns"]["max"], json["tick_ns"]["p50"]);
  EXPECT_GT(json["engine_bytes"], 0);
  EXPECT_EQ(json["undecided"], 0);  // no budget
  EXPECT_EQ(replay({"--quiet"}).out, "");
}

TEST_F(Replay, Profile_tells_stages_queries_and_pools) {
  const auto json = nlohmann::json::parse(replay({"--json", "--profile"}).out)["profile"];
  EXPECT_EQ(json["ticks"], 6);
  EXPECT_GT(json["stage_ns"]["refine"], 0);
  EXPECT_GT(json["own_queries"].get<int>() + json["culling_queries"].get<int>(), 0);
  EXPECT_GT(json["most_nodes"], 1);
  EXPECT_GE(json["most_contacts"], 1);
  const std::string text = replay({"--quiet", "--profile"}).out;
  EXPECT_EQ(text.find("start "), 0u) << text;
}

TEST_F(Replay, Refused_input_exits_3_and_writes_nothing) {
  folder_.write("poses.csv", "t,body,px,py,pz,qw,qx,qy,qz\n0,tool,nan,0,0,1,0,0,0\n");
  expect_refusal(replay({"--contacts", at("contacts.csv")}), 3, "poses.csv:2: ");
  folder_.write("poses.csv", "t,body,px,py,pz,qw,qx,qy,qz\n0,wall,0,0,0,1,0,0,0\n");
  expect_refusal(replay(), 3, "'wall' is fixed");
}

TEST_F(Replay, Damaged_image_exits_3) {
  const std::string whole = test::read_file(at("cube.palp"));
  folder_.write("cube.palp", whole.substr(0, whole.size() - 1));
  expect_refusal(replay(), 3, "cube.palp");
  folder_.write("cube.palp", "");
  expect_refusal(replay(), 3, "cube.palp");
}

TEST_F(Replay, Scene_that_needs_more_memory_than_it_allows_exits_3) {
  write_scene("", "[limits]\nmax_memory_MB = 0.001\n");  // less than the image
  expect_refusal(replay(), 3, "memory, more than it allows");
  write_scene("", "[limits]\nmax_memory_MB = 0.02\n");  // less than image and engine
  expect_refusal(replay(), 3, "memory, more than it allows");
}

TEST_F(Replay, Wrong_scene_exits_2) {
  write_scene("delta = 1.0");
  expect_refusal(replay(), 2, "scene.toml:3: did you mean 'delta_m'?");
}

TEST_F(Replay, Wrong_options_exit_2) {
  expect_refusal(replay({"--engine", "other"}), 2, "palpate replay --help");
  expect_refusal(replay({"--kappa", "-1"}), 2, "--kappa");
  expect_refusal(replay({"--force-tolerance", "-1"}), 2, "--force-tolerance");
  expect_refusal(replay({"--budget-us", "1", "--budget-units", "1"}), 2, "xcludes");
  expect_refusal(replay({"--s0", "-1"}), 2, "--s0");
  expect_refusal(replay({"--s0", "nan"}), 2, "--s0");
  expect_refusal(replay({"--budget-us", "nan"}), 2, "--budget-us");
  expect_refusal(replay({"--budget-units", "-1"}), 2, "--budget-units");
  expect_refusal(replay({"--budget-units", "1.5"}), 2, "--budget-units");
  expect_refusal(replay({"--reserve-units", "1"}), 2, "--budget-units");
  expect_refusal(replay({"--budget-units", "1", "--reserve-us", "1"}), 2, "xcludes");
  expect_refusal(replay({"--budget-units", "1", "--reserve-units", "-1"}), 2, "--reserve-units");
  expect_refusal(replay({"--reserve-us", "-1"}), 2, "--reserve-us");
  expect_refusal(replay({"--repeat", "0"}), 2, "--repeat");
  expect_refusal(replay({"--contacts", at("ticks.csv")}), 2, "cannot be one file");
  expect_refusal(replay({"--surprise"}), 2, "--surprise");
}

TEST_F(Replay, Output_that_cannot_be_written_exits_1_and_leaves_none) {
  expect_refusal(replay({"--contacts", at("absent/contacts.csv")}), 1, "absent/contacts.csv");
}

}  // namespace
}  // namespace palpate
