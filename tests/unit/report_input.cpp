// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_input.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "config/scene.hpp"
#include "tests/unit/report_support.hpp"
#include "tools/realtime/trace.hpp"

namespace palpate::cli {
namespace {

class ReportFolder : public ::testing::Test {
 protected:
  ReportFolder() {
    folder_.write("cube.palp", test::cube_image());
    folder_.write("cubes.toml", test::cube_scene());
    folder_.write("poses.csv", test::cube_poses(kTicks));
    folder_.write("fast.csv", ticks_csv(test::some_ticks(kTicks)));
  }
  ReportInput read(const ReportHints& hints = {}) {
    return read_report_input(folder_.path(), hints);
  }
  static constexpr int kTicks = 6;
  test::TemporaryFolder folder_;
};

TEST_F(ReportFolder, files_are_told_apart_by_their_first_lines) {
  folder_.write("notes.csv", "something,else\n1,2\n");
  folder_.write("fast_contacts.csv", std::string(kContactsHeader) + "\n");
  const ReportInput input = read();
  EXPECT_EQ(input.kind, ReportKind::replay);
  ASSERT_EQ(input.lines.size(), 1u);
  EXPECT_EQ(input.lines[0].name, "fast");
  ASSERT_EQ(input.lines[0].ticks.size(), std::size_t(kTicks));
  EXPECT_EQ(input.lines[0].ticks[5].wrench.force_N.x, 0.5);
  ASSERT_TRUE(input.view);
  EXPECT_EQ(input.view->contacts.filename(), "fast_contacts.csv");
  EXPECT_EQ(input.view->track.ticks.size(), std::size_t(kTicks));
  EXPECT_FALSE(input.judged);
  EXPECT_TRUE(input.notes.empty());
}

TEST_F(ReportFolder, exact_tables_come_first) {
  folder_.write("zero.csv", ticks_csv(test::some_ticks(kTicks)));
  folder_.write("exact_levels.csv", ticks_csv(test::some_ticks(kTicks)));
  const ReportInput input = read();
  ASSERT_EQ(input.lines.size(), 3u);
  EXPECT_EQ(input.lines[0].name, "exact_levels");
  EXPECT_TRUE(input.lines[0].exact);
  EXPECT_EQ(input.lines[1].name, "fast");
  EXPECT_EQ(input.lines[2].name, "zero");
  ASSERT_TRUE(input.judged);
  EXPECT_EQ(input.judged->delta_m, 0.0005);
  EXPECT_GT(input.judged->radius_m, 0.0);
}

TEST_F(ReportFolder, contacts_go_with_the_table_of_their_name) {
  const std::string contacts = std::string(kContactsHeader) + "\n";
  folder_.write("exact.csv", ticks_csv(test::some_ticks(kTicks)));
  folder_.write("exact_contacts.csv", contacts);
  ReportInput input = read();
  EXPECT_EQ(input.view->contacts.filename(), "exact_contacts.csv");
  EXPECT_EQ(input.lines[input.view->contacts_of].name, "exact");
  folder_.write("contacts-fast.csv", contacts);
  folder_.write("other_contacts.csv", contacts);
  input = read();
  EXPECT_EQ(input.lines[input.view->contacts_of].name, "exact");
  folder_.write("fast_contacts.csv", contacts);
  input = read();
  EXPECT_EQ(input.lines[input.view->contacts_of].name, "fast");
}

TEST_F(ReportFolder, tables_of_different_lengths_are_refused) {
  folder_.write("short.csv", ticks_csv(test::some_ticks(kTicks - 1)));
  EXPECT_NE(test::failure_of([&] { (void)read(); }).find("different lengths"), std::string::npos);
}

TEST_F(ReportFolder, table_cut_short_is_refused) {
  const std::string whole = ticks_csv(test::some_ticks(kTicks));
  folder_.write("fast.csv", whole.substr(0, whole.size() - 5));
  EXPECT_NE(test::failure_of([&] { (void)read(); }).find("fast.csv"), std::string::npos);
}

TEST_F(ReportFolder, nothing_to_report_is_refused) {
  const test::TemporaryFolder empty;
  EXPECT_NE(test::failure_of([&] {
              (void)read_report_input(empty.path(), {});
            }).find("nothing to report"),
            std::string::npos);
  EXPECT_NE(test::failure_of([&] {
              (void)read_report_input(empty.path() / "none", {});
            }).find("no such folder"),
            std::string::npos);
}

TEST_F(ReportFolder, unclear_scene_costs_the_view_and_leaves_a_note) {
  folder_.write("second.toml", test::cube_scene());
  ReportInput input = read();
  EXPECT_FALSE(input.view);
  ASSERT_EQ(input.notes.size(), 1u);
  EXPECT_NE(input.notes[0].find("--scene"), std::string::npos);
  input = read({folder_.path() / "second.toml", {}});
  EXPECT_TRUE(input.view);
}

TEST_F(ReportFolder, broken_scene_is_a_note_when_found_and_an_error_when_named) {
  const auto scene = folder_.write("cubes.toml", "[engine]\nnonsense = 1\n");
  const ReportInput input = read();
  EXPECT_FALSE(input.view);
  ASSERT_EQ(input.notes.size(), 1u);
  EXPECT_THROW((void)read({scene, {}}), config::ConfigError);
}

TEST_F(ReportFolder, poses_of_another_motion_are_no_view) {
  folder_.write("poses.csv", test::cube_poses(kTicks + 1));
  const ReportInput input = read();
  EXPECT_FALSE(input.view);
  ASSERT_EQ(input.notes.size(), 1u);
  EXPECT_NE(input.notes[0].find("7 poses for 6 ticks"), std::string::npos);
}

/// What a replay writes beside its table.
std::string about_json(const std::filesystem::path& scene, const std::filesystem::path& poses) {
  return R"({"scene": ")" + scene.string() + R"(", "poses": ")" + poses.string() + "\"}";
}

TEST_F(ReportFolder, replays_say_which_scene_and_poses_they_are_of) {
  const test::TemporaryFolder other;
  for (const char* name : {"cube.palp", "cubes.toml", "poses.csv"}) {
    std::filesystem::rename(folder_.path() / name, other.path() / name);
  }
  EXPECT_FALSE(read().view);
  const std::string about = about_json(other.path() / "cubes.toml", other.path() / "poses.csv");
  folder_.write("fast.about.json", about);
  folder_.write("slow.about.json", about);
  EXPECT_TRUE(read().view);
  // Where they do not agree, or what they name is gone, the folder's own files count.
  folder_.write("slow.about.json", about_json(other.path() / "cubes.toml", "/other.csv"));
  EXPECT_FALSE(read().view);
  folder_.write("fast.about.json", about_json("/gone.toml", "/gone.csv"));
  folder_.write("slow.about.json", "these are words");
  EXPECT_FALSE(read().view);
}

TEST_F(ReportFolder, sweep_shows_exact_runs_and_best_trades_of_many) {
  folder_.write("sweep.json", test::read_file(PALPATE_TEST_DATA "/sweep.json"));
  std::filesystem::remove(folder_.path() / "fast.csv");
  std::filesystem::create_directory(folder_.path() / "ticks");
  for (const SweepPoint& point : read_sweep(folder_.path() / "sweep.json")) {
    folder_.write("ticks/" + point.id + ".csv", ticks_csv(test::some_ticks(kTicks)));
  }
  folder_.write("about.json", "{\"scene\": \"" + (folder_.path() / "cubes.toml").string() +
                                  "\", \"poses\": \"" + (folder_.path() / "poses.csv").string() +
                                  "\"}");
  const ReportInput input = read();
  EXPECT_EQ(input.kind, ReportKind::sweep);
  EXPECT_EQ(input.settings.size(), 11u);
  ASSERT_EQ(input.lines.size(), kMaxReportLines);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(input.lines[i].exact) << input.lines[i].name;
  for (std::size_t i = 3; i < 6; ++i) {
    EXPECT_EQ(input.lines[i].name.rfind("regions, force tolerance", 0), 0u) << input.lines[i].name;
  }
  ASSERT_EQ(input.notes.size(), 1u);
  EXPECT_TRUE(input.view);
}

class ReportTrace : public ::testing::Test {
 protected:
  /// Ticks 0, 1 and 3 of a loop of 1 kHz, which dropped nothing.
  std::string trace() {
    std::string scene = folder_.write("cubes.toml", test::cube_scene()).string();
    realtime::TraceHeader header;
    header.record_bytes = sizeof(realtime::TraceRecord);
    header.scene_bytes = static_cast<std::uint32_t>(scene.size());
    scene.resize((scene.size() + 7) / 8 * 8, '\0');
    header.header_bytes = static_cast<std::uint32_t>(sizeof header + scene.size());
    header.records = 3;
    header.rate_Hz = 1000;
    std::string bytes(sizeof header, '\0');
    std::memcpy(bytes.data(), &header, sizeof header);
    bytes += scene;
    for (const std::uint64_t period : {0u, 1u, 3u}) {
      realtime::TraceRecord r;
      r.time_ns = period * 1'000'000;
      if (period > 0) r.orientation = {1, 0, 0, 0};  // before: no reading yet
      r.position_m = {0.001 * double(period), 0, 0};
      r.rendered_force_N = {0, 0.5 * double(period), 0};
      r.sent_force_N = {0, 0, 0.25f * float(period)};
      r.latency_ns = 1000;
      r.tick_ns = 5000;
      std::string record(sizeof r, '\0');
      std::memcpy(record.data(), &r, sizeof r);
      bytes += record;
    }
    return bytes;
  }
  ReportInput read(const std::string& bytes, const ReportHints& hints = {}) {
    return read_report_input(folder_.write("run.trace", bytes), hints);
  }
  test::TemporaryFolder folder_;
};

TEST_F(ReportTrace, records_become_ticks_and_poses) {
  const ReportInput input = read(trace());
  EXPECT_EQ(input.kind, ReportKind::run);
  ASSERT_EQ(input.lines.size(), 1u);
  ASSERT_EQ(input.lines[0].ticks.size(), 3u);
  EXPECT_EQ(input.lines[0].ticks[2].t_s, 0.003);
  EXPECT_EQ(input.lines[0].ticks[2].wrench.force_N.y, 1.5);
  ASSERT_TRUE(input.run);
  EXPECT_EQ(input.run->missed, 1u);
  EXPECT_EQ(input.run->sent_force_max_N, 0.75);
  EXPECT_EQ(input.run->latency_ns, (std::vector<std::uint32_t>{1000, 1000, 1000}));
  ASSERT_TRUE(input.view);
  ASSERT_EQ(input.view->track.ticks.size(), 3u);
  EXPECT_EQ(input.view->track.ticks[0].changes, 0u);
  EXPECT_EQ(input.view->track.ticks[2].changes, 1u);
  EXPECT_EQ(input.view->track.changes.back().pose.position_m.x, 0.003);
}

TEST_F(ReportTrace, every_shorter_or_longer_file_is_refused) {
  const std::string whole = trace();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(test::failure_of([&] { (void)read(whole.substr(0, size)); }), "") << size;
  }
  EXPECT_NE(test::failure_of([&] { (void)read(whole + '\0'); }), "");
}

TEST_F(ReportTrace, hostile_headers_are_refused) {
  const std::string whole = trace();
  for (std::size_t at = 0; at < 32; ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
    EXPECT_NE(test::failure_of([&] { (void)read(bytes); }), "") << at;
  }
}

TEST_F(ReportTrace, scene_that_has_gone_is_a_note_and_can_be_named) {
  const std::string bytes = trace();
  std::filesystem::rename(folder_.path() / "cubes.toml", folder_.path() / "moved.toml");
  const ReportInput input = read(bytes);
  EXPECT_FALSE(input.view);
  EXPECT_EQ(input.notes.size(), 1u);
  EXPECT_TRUE(read(bytes, {folder_.path() / "moved.toml", {}}).view);
}

}  // namespace
}  // namespace palpate::cli
