// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_json.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "tests/unit/report_support.hpp"
#include "tools/palpate/report_page.hpp"

namespace palpate::cli {
namespace {

/// Decodes by its own means.
std::string decoded(const std::string& text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0, have = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6 | unsigned(kDigits.find(c))) & 0xffffu;
    have += 6;
    if (have >= 8) out += static_cast<char>(bits >> (have -= 8) & 0xffu);
  }
  return out;
}

std::vector<float> floats(const nlohmann::ordered_json& text) {
  const std::string bytes = decoded(text.get<std::string>());
  std::vector<float> out(bytes.size() / sizeof(float));
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

ReportInput replay_of(std::size_t ticks) {
  ReportInput input;
  input.name = "cubes";
  input.lines.resize(2);
  input.lines[0].name = "exact";
  input.lines[0].exact = true;
  input.lines[0].ticks = test::some_ticks(ticks);
  input.lines[1].name = "fast";
  input.lines[1].ticks = test::some_ticks(ticks);
  for (TickRow& row : input.lines[1].ticks) row.min_distance_m += 2e-6;
  return input;
}

TEST(ReportBase64, is_that_of_RFC_4648) {
  const std::array<std::array<const char*, 2>, 7> examples = {{{"", ""},
                                                               {"f", "Zg=="},
                                                               {"fo", "Zm8="},
                                                               {"foo", "Zm9v"},
                                                               {"foob", "Zm9vYg=="},
                                                               {"fooba", "Zm9vYmE="},
                                                               {"foobar", "Zm9vYmFy"}}};
  for (const auto& [plain, coded] : examples) {
    EXPECT_EQ(base64(std::as_bytes(std::span(std::string_view(plain)))), coded);
  }
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  EXPECT_EQ(decoded(base64(std::as_bytes(std::span(all)))), all);
}

TEST(ReportJson, lines_hold_a_figure_a_frame) {
  const ReportInput input = replay_of(5);
  const auto made = report_json(input, frames_of(5));
  EXPECT_EQ(made.at("kind"), "replay");
  EXPECT_EQ(made.at("frames").at("count"), 5);
  const auto& fast = made.at("lines").at(1);
  EXPECT_EQ(fast.at("name"), "fast");
  EXPECT_EQ(floats(fast.at("force_N"))[3], 0.3f);
  EXPECT_EQ(floats(fast.at("time_us"))[3], 4.0f);
  EXPECT_EQ(floats(fast.at("front"))[3], 13.0f);
  EXPECT_EQ(floats(fast.at("bound_m"))[3], 4e-5f);
  const std::vector<float> errors = floats(fast.at("error_m"));
  EXPECT_TRUE(std::isnan(errors[0]));
  EXPECT_NEAR(double(errors[3]), 2e-6, 1e-12);
  EXPECT_FALSE(made.at("lines").at(0).contains("error_m"));
}

TEST(ReportJson, rounding_counts_as_no_error) {
  ReportInput input = replay_of(3);
  for (TickRow& row : input.lines[1].ticks) row.min_distance_m += 1e-16 - 2e-6;
  const auto made = report_json(input, frames_of(3));
  EXPECT_EQ(floats(made.at("lines").at(1).at("error_m"))[2], 0.0f);
}

TEST(ReportJson, ticks_that_were_not_timed_are_gaps) {
  ReportInput input = replay_of(4);
  for (ReportLine& line : input.lines) {
    for (TickRow& row : line.ticks) row.time_ns = 0;
  }
  const auto made = report_json(input, frames_of(4));
  for (const float us : floats(made.at("lines").at(0).at("time_us"))) EXPECT_TRUE(std::isnan(us));
  EXPECT_TRUE(made.at("latency").is_null());
}

TEST(ReportJson, long_recordings_say_what_was_left_out) {
  const ReportInput input = replay_of(2 * kMaxFrames + 1);
  const auto made = report_json(input, frames_of(2 * kMaxFrames + 1));
  EXPECT_EQ(made.at("frames").at("stride"), 3);
  ASSERT_EQ(made.at("notes").size(), 1u);
  EXPECT_EQ(floats(made.at("lines").at(0).at("force_N")).size(), made.at("frames").at("count"));
}

/// Ticks 0, 1 and 3 of a loop of 1 kHz; the last one has a fault.
ReportInput run_of_three() {
  ReportInput input;
  input.kind = ReportKind::run;
  input.lines.resize(1);
  input.lines[0].ticks = test::some_ticks(3);
  ReportRun& run = input.run.emplace();
  run.rate_Hz = 1000;
  for (const std::uint64_t period : {0u, 1u, 3u}) {
    realtime::TraceRecord& r = run.records.emplace_back();
    r.time_ns = period * 1'000'000;
    r.position_m = {0, 0, 0.5 + 0.001 * double(period)};
    r.sent_force_N = {3 * float(period), 0, 4 * float(period)};
    r.state_age_ns = 250'000;
    r.energy_J = 0.002;
    r.faults = period == 3 ? 0b101 : 0;
    run.latency_ns.push_back(1000);
  }
  return input;
}

TEST(ReportJson, run_holds_what_was_sent_and_what_went_wrong) {
  const auto run = report_json(run_of_three(), frames_of(3)).at("run");
  EXPECT_EQ(run.at("period_us"), 1000);
  EXPECT_TRUE(run.at("budget_us").is_null());  // no scene
  EXPECT_EQ(floats(run.at("sent_N")), (std::vector<float>{0, 5, 15}));
  EXPECT_EQ(floats(run.at("sent_xyz_N").at(2)), (std::vector<float>{0, 4, 12}));
  EXPECT_NEAR(double(floats(run.at("moved_xyz_mm").at(2))[2]), 3, 1e-5);
  EXPECT_EQ(floats(run.at("energy_mJ"))[0], 2);
  EXPECT_EQ(floats(run.at("age_us"))[0], 250);
  const auto& marks = run.at("marks");
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_TRUE(marks.at(0).at("fault").is_null());  // a deadline
  EXPECT_EQ(marks.at(1).at("fault"), "stale_state, missed_deadlines");
  EXPECT_EQ(marks.at(1).at("t_s"), 0.003);
}

TEST(ReportJson, gaps_of_a_trace_that_lost_ticks_are_no_missed_deadlines) {
  ReportInput input = run_of_three();
  input.run->dropped = 1;
  EXPECT_EQ(report_json(input, frames_of(3)).at("run").at("marks").size(), 1u);
}

TEST(ReportJson, plots_show_every_tick_of_a_minute) {
  EXPECT_EQ(plot_frames_of(60'000, 1).stride, 1u);
  EXPECT_EQ(plot_frames_of(60'000, 8).stride, 5u);
  EXPECT_EQ(plot_frames_of(5'000, 100).stride, 1u);
  const auto made = frames_json(run_of_three(), frames_of(3, 2));
  EXPECT_EQ(made.at("count"), 2);
  EXPECT_EQ(made.at("stride"), 2);
  EXPECT_EQ(floats(made.at("t_s")), (std::vector<float>{0, 0.002f}));
}

TEST(ReportJson, settings_without_error_are_drawn_below_all_others) {
  ReportInput input;
  input.kind = ReportKind::sweep;
  input.settings = read_sweep(PALPATE_TEST_DATA "/sweep.json");
  input.settings[1].force_nrmse = 1e-6;  // rounding
  const auto made = report_json(input, {});
  double least = 1;
  for (const auto& s : made.at("settings")) {
    const double error = s.at("force_nrmse");
    if (error > 1e-4) {
      EXPECT_EQ(s.at("drawn_nrmse"), error);
      least = std::min(least, error);
    }
  }
  for (const auto& s : made.at("settings")) {
    if (s.at("force_nrmse") <= 1e-4) {
      EXPECT_EQ(s.at("drawn_nrmse"), least / 2);
    }
  }
  EXPECT_TRUE(made.at("lines").empty());
}

class ReportView : public ::testing::Test {
 protected:
  ReportView() {
    folder_.write("cube.palp", test::cube_image());
    view_.scene = config::load_scene(folder_.write("cubes.toml", test::cube_scene()));
    view_.track = read_poses(folder_.write("poses.csv", test::cube_poses(6)), view_.scene);
  }
  test::TemporaryFolder folder_;
  ReportScene view_;
};

TEST_F(ReportView, bodies_share_an_image_and_have_tracks_of_their_own) {
  const Frames frames = frames_of(6);
  const auto made = view_json(view_, replay_shown_contacts(view_, frames, {}), frames);
  EXPECT_EQ(made.at("images").size(), 1u);
  ASSERT_EQ(made.at("bodies").size(), 2u);
  const std::vector<float> tool = floats(made.at("bodies").at(0).at("track"));
  ASSERT_EQ(tool.size(), 42u);
  EXPECT_NEAR(double(tool[7 * 5]), 0.01,
              1e-7);                 // 0.011 m - 5 * 0.2 mm, from where the scene has it
  EXPECT_EQ(tool[7 * 5 + 6], 1.0f);  // x y z w
  const auto& contacts = made.at("contacts");
  const std::size_t shown = floats(contacts.at("distances")).size();
  ASSERT_GT(shown, 0u);
  EXPECT_EQ(floats(contacts.at("points")).size(), 6 * shown);
  EXPECT_EQ(floats(contacts.at("forces_N")).size(), shown);
  EXPECT_EQ(floats(contacts.at("sides")).size(), 6 * shown);
  EXPECT_EQ(floats(contacts.at("starts")).size(), 7u);
}

TEST_F(ReportView, contacts_on_pieces_that_are_not_there_are_refused) {
  const Frames frames = frames_of(6);
  ShownContacts shown = replay_shown_contacts(view_, frames, {});
  shown.contacts.front().piece_b = 1000;
  const std::string said = test::failure_of([&] { (void)view_json(view_, shown, frames); });
  EXPECT_NE(said.find("piece 1000"), std::string::npos) << said;
}

TEST(ReportPage, data_cannot_end_their_element) {
  const test::TemporaryFolder folder;
  const auto page = folder.write("report.html", "<script>@PALPATE_REPORT@</script>");
  const nlohmann::ordered_json data = {{"name", "</script><b>\xff"}};
  const std::string text = fill_page(page, data);
  EXPECT_EQ(text.find("</script>"), text.size() - 9);
  EXPECT_EQ(text.find("<b>"), std::string::npos);
  const std::string inside = text.substr(8, text.size() - 17);
  EXPECT_EQ(nlohmann::json::parse(inside).at("name").get<std::string>().substr(0, 12),
            "</script><b>");
}

TEST(ReportPage, page_without_its_place_is_refused) {
  const test::TemporaryFolder folder;
  for (const char* text : {"", "<html>", "@PALPATE_REPORT@@PALPATE_REPORT@"}) {
    const auto page = folder.write("report.html", text);
    EXPECT_NE(test::failure_of([&] { (void)fill_page(page, {}); }), "") << text;
  }
  EXPECT_NE(test::failure_of([&] { (void)fill_page(folder.path() / "none", {}); }), "");
}

}  // namespace
}  // namespace palpate::cli
