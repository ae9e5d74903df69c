// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate run` and `palpate doctor` as processes: two cubes of a centimetre, the hand pressing one
// on the other along x. How late a tick is depends on the machine, so exit statuses 0 and 5 are
// both right.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/cube_scene.hpp"
#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"

namespace palpate {
namespace {

using nlohmann::json;

/// The hand presses the tool into the base and stays there.
constexpr const char* kPress = R"([[mock.path]]
t_s = 0.0
position = [0.0102, 0.0, 0.0]
[[mock.path]]
t_s = 0.2
position = [0.0090, 0.0, 0.0]
[[mock.path]]
t_s = 100.0
position = [0.0090, 0.0, 0.0]
)";

class Run : public ::testing::Test {
 protected:
  Run() {
    folder_.write("cube.palp", test::cube_image());
    folder_.write("scene.toml", test::cube_loop_scene(kPress));
  }

  test::Outcome run(std::vector<std::string> options) const {
    options.insert(options.begin(),
                   {PALPATE_EXECUTABLE, "run", (folder_.path() / "scene.toml").string()});
    return test::run(options);
  }

  test::TemporaryFolder folder_;
};

bool kept_or_late(int status) { return status == 0 || status == 5; }

TEST_F(Run, json_has_every_documented_key) {
  const test::Outcome outcome = run({"--seconds", "0.6", "--json", "--quiet"});
  ASSERT_TRUE(kept_or_late(outcome.status)) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const json j = json::parse(outcome.out);
  for (const char* key :
       {"ticks", "rate_hz", "missed", "overrun_ns_max", "latency_ns", "tick_ns", "allocations",
        "page_faults", "truncated", "undecided", "on_reserve", "contacts_mean", "force_N",
        "energy_J_min", "state", "faults", "scheduler", "telemetry_dropped"}) {
    EXPECT_TRUE(j.contains(key)) << key;
  }
  for (const char* key : {"p50", "p99", "p999", "max"}) {
    EXPECT_TRUE(j["latency_ns"].contains(key)) << key;
    EXPECT_TRUE(j["tick_ns"].contains(key)) << key;
  }
  EXPECT_GE(j["ticks"].get<int>() + j["missed"].get<int>(), 600);
  EXPECT_EQ(j["rate_hz"], 1000.0);
}

TEST_F(Run, exit_status_says_whether_every_promise_was_kept) {
  const test::Outcome outcome = run({"--seconds", "0.6", "--json", "--quiet"});
  const json j = json::parse(outcome.out);
  const int allocations = j["allocations"].is_null() ? 0 : j["allocations"].get<int>();
  const bool kept = j["missed"] == 0 && j["page_faults"] == 0 && allocations == 0;
  if (j["faults"].empty()) {
    EXPECT_EQ(outcome.status, kept ? 0 : 5);
  }
  EXPECT_EQ(allocations, 0);
}

TEST_F(Run, pressing_hand_feels_a_force_within_the_scenes_limit) {
  const json j = json::parse(run({"--seconds", "1.0", "--json", "--quiet"}).out);
  if (!j["faults"].empty()) GTEST_SKIP() << "the machine is too busy to hold the loop up";
  EXPECT_GT(j["force_N"]["max"].get<double>(), 0.01);
  EXPECT_LE(j["force_N"]["max"].get<double>(), 0.5);
  EXPECT_EQ(j["state"], "rendering");
}

TEST_F(Run, contacts_on_a_thread_of_their_own_with_friction_and_damping_are_felt) {
  for (const char* coupling : {"direct", "virtual"}) {
    std::string scene = test::cube_loop_scene(kPress);
    scene.replace(
        scene.find("max_force_N"), 0,
        "contact_damping_N_s_per_m = 0.2\ncoupling = \"" + std::string(coupling) + "\"\n");
    scene += "[[pair]]\na = \"tool\"\nb = \"base\"\nfriction = 0.3\n";
    scene += "[run]\ncontact_rate_Hz = 200\n";
    folder_.write("scene.toml", scene);
    const test::Outcome outcome = run({"--seconds", "1.0", "--json", "--quiet"});
    ASSERT_TRUE(outcome.status != 2 && outcome.status != 3) << outcome.err;
    const json j = json::parse(outcome.out);
    EXPECT_TRUE(j["contacts_late"].is_number()) << coupling;
    if (!j["faults"].empty()) continue;  // the machine is too busy to hold the loop up
    EXPECT_GT(j["force_N"]["max"].get<double>(), 0.01) << coupling;
    EXPECT_LE(j["force_N"]["max"].get<double>(), 0.5) << coupling;
  }
}

TEST_F(Run, text_names_what_a_reader_looks_for) {
  const test::Outcome outcome = run({"--seconds", "0.2"});
  ASSERT_TRUE(kept_or_late(outcome.status)) << outcome.err;
  for (const char* word : {"deadlines", "wake-up lateness", "tick time", "contacts", "force",
                           "allocations", "page faults", "scheduler", "romise"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
}

TEST_F(Run, rate_of_the_command_line_overrides_the_scenes) {
  const json j = json::parse(run({"--seconds", "0.5", "--rate", "200", "--json", "--quiet"}).out);
  EXPECT_EQ(j["rate_hz"], 200.0);
  EXPECT_NEAR(j["ticks"].get<int>() + j["missed"].get<int>(), 100, 60);
}

TEST_F(Run, trace_holds_a_record_for_each_tick) {
  const auto file = folder_.path() / "run.trace";
  const json j =
      json::parse(run({"--seconds", "0.5", "--json", "--quiet", "--output", file.string()}).out);
  const std::string trace = test::read_file(file);
  ASSERT_GT(trace.size(), 64u);
  EXPECT_EQ(trace.substr(0, 8), "PALTRACE");
  std::uint64_t records = 0;
  std::memcpy(&records, trace.data() + 24, sizeof records);
  EXPECT_EQ(records, j["ticks"].get<std::uint64_t>() - j["telemetry_dropped"].get<std::uint64_t>());
}

TEST_F(Run, recorded_motion_moves_the_mock_hand_once) {
  folder_.write("scene.toml", test::cube_loop_scene());
  // Half a second down, 1.2 mm, which presses by more than the delta.
  std::string poses = "t,body,px,py,pz,qw,qx,qy,qz\n7,tool,0.0106,0,0,1,0,0,0\n";
  poses += "7.3,tool,0.0094,0,0,1,0,0,0\n7.5,tool,0.0094,0,0,1,0,0,0\n";
  const std::string file = folder_.write("poses.csv", poses);
  const test::Outcome outcome = run({"--poses", file, "--json"});
  ASSERT_TRUE(outcome.status != 2 && outcome.status != 3) << outcome.err;
  EXPECT_EQ(outcome.err.find("stands still"), std::string::npos) << outcome.err;
  const json j = json::parse(outcome.out);
  // A last tick that ends late passes the end of the run.
  EXPECT_GE(j["ticks"].get<int>() + j["missed"].get<int>(), 500);
  if (!j["faults"].empty()) GTEST_SKIP() << "the machine is too busy to hold the loop up";
  EXPECT_GT(j["force_N"]["max"].get<double>(), 0.01);
}

TEST_F(Run, motion_that_the_hand_cannot_make_is_refused) {
  const std::string file =
      folder_.write("poses.csv", "t,body,px,py,pz,qw,qx,qy,qz\n0,tool,0.0106,0,0,1,0,0,0\n");
  const test::Outcome device = run({"--poses", file, "--device", "usb"});
  EXPECT_EQ(device.status, 2);
  EXPECT_NE(device.err.find("only the mock hand plays a motion"), std::string::npos) << device.err;
  std::string scene = test::cube_loop_scene();
  scene.replace(scene.find("\"fixed\""), 7, "\"moved\"");
  folder_.write("scene.toml", scene);
  folder_.write("poses.csv", "t,body,px,py,pz,qw,qx,qy,qz\n0,base,0,0,0,1,0,0,0\n");
  const test::Outcome other = run({"--poses", file});
  EXPECT_EQ(other.status, 3);
  EXPECT_NE(other.err.find("the poses move 'base'"), std::string::npos) << other.err;
  EXPECT_EQ(run({"--poses", "/no/such/file"}).status, 3);
}

TEST_F(Run, hand_that_stands_still_is_said_in_one_line) {
  folder_.write("scene.toml", test::cube_loop_scene());
  const test::Outcome still = run({"--seconds", "0.1"});
  EXPECT_NE(still.err.find("The mock hand stands still: --poses FILE"), std::string::npos);
  EXPECT_EQ(run({"--seconds", "0.1", "--quiet"}).err, "");
}

TEST_F(Run, bodies_that_overlap_at_the_start_are_named) {
  EXPECT_EQ(run({"--seconds", "0.1"}).err.find("overlap"), std::string::npos);
  std::string scene = test::cube_loop_scene();
  scene.replace(scene.find("0.0102"), 6, "0.0097");
  folder_.write("scene.toml", scene);
  const test::Outcome outcome = run({"--seconds", "0.1"});
  EXPECT_NE(outcome.err.find("'tool' and 'base' overlap at the start, by 0.0003 m"),
            std::string::npos)
      << outcome.err;
}

TEST_F(Run, device_that_is_not_there_is_a_device_error) {
  for (const char* device : {"usb:no such serial", "falcon:no such serial"}) {
    const test::Outcome outcome = run({"--device", device});
    EXPECT_EQ(outcome.status, 4);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.rfind("palpate: error: device failed at ", 0), 0u) << outcome.err;
  }
}

TEST_F(Run, wrong_options_are_a_usage_error) {
  EXPECT_EQ(run({"--device", "pencil"}).status, 2);
  EXPECT_EQ(run({"--rate", "0"}).status, 2);
  EXPECT_EQ(run({"--seconds", "-1"}).status, 2);
  EXPECT_EQ(run({"--priority", "99"}).status, 2);
}

TEST_F(Run, impossible_trace_is_refused_before_the_run) {
  const test::Outcome outcome = run({"-o", (folder_.path() / "none" / "x.trace").string()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("cannot write the trace"), std::string::npos) << outcome.err;
}

TEST(Doctor, json_is_a_list_of_checks_with_the_documented_keys) {
  const test::Outcome outcome = test::run({PALPATE_EXECUTABLE, "doctor", "--json"});
  const json list = json::parse(outcome.out);
  ASSERT_GE(list.size(), 8u);
  const bool ready = std::all_of(list.begin(), list.end(), [](const json& c) { return c["ok"]; });
  EXPECT_EQ(outcome.status, ready ? 0 : 1);
  for (const json& check : list) {
    for (const char* key : {"check", "ok", "found", "wanted", "mend"}) {
      EXPECT_TRUE(check.contains(key)) << key;
    }
    EXPECT_EQ(check["ok"].get<bool>(), check["mend"] == "");
  }
}

TEST(Doctor, text_exits_with_1_where_something_is_to_be_fixed) {
  const test::Outcome outcome = test::run({PALPATE_EXECUTABLE, "doctor"});
  const bool ready = outcome.out.find("wanted: ") == std::string::npos;
  EXPECT_EQ(outcome.status, ready ? 0 : 1) << outcome.out;
}

}  // namespace
}  // namespace palpate
