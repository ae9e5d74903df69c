// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_contacts.hpp"

#include <gtest/gtest.h>

#include "tests/unit/report_support.hpp"

namespace palpate::cli {
namespace {

/// A row of a tick whose force is the larger the smaller the distance is.
std::string row(std::size_t tick, double distance_m, const std::string& pair = "0") {
  return std::to_string(tick) + "," + pair + ",1,2,3,4,5,6,1,0,0," + std::to_string(distance_m) +
         ",7,1,8,2,1\n";
}

class ReportContacts : public ::testing::Test {
 protected:
  ReportContacts() {
    folder_.write("cube.palp", test::cube_image());
    view_.scene = config::load_scene(folder_.write("cubes.toml", test::cube_scene()));
    view_.track = read_poses(folder_.write("poses.csv", test::cube_poses(kTicks)), view_.scene);
    line_.ticks = test::some_ticks(kTicks);
  }
  ShownContacts read(const std::string& rows, std::size_t limit = kMaxFrames) {
    view_.contacts = folder_.write("contacts.csv", std::string(kContactsHeader) + "\n" + rows);
    return read_shown_contacts(view_, line_, frames_of(kTicks, limit));
  }
  static constexpr std::size_t kTicks = 6;
  test::TemporaryFolder folder_;
  ReportScene view_;
  ReportLine line_;
};

TEST_F(ReportContacts, rows_go_to_their_frames_strongest_first) {
  line_.ticks[1].contacts = 3;
  line_.ticks[5].contacts = 1;
  const ShownContacts shown = read(row(1, 2e-4) + row(1, -1e-4) + row(1, 1e-4) + row(5, 3e-4));
  EXPECT_EQ(shown.found, (std::vector<std::uint32_t>{0, 3, 0, 0, 0, 1}));
  EXPECT_EQ(shown.starts, (std::vector<std::uint32_t>{0, 0, 3, 3, 3, 3, 4}));
  EXPECT_DOUBLE_EQ(shown.contacts[0].distance_m, -1e-4);
  EXPECT_DOUBLE_EQ(shown.contacts[2].distance_m, 2e-4);
  EXPECT_EQ(shown.contacts[0].point_b_m.y, 5);
  EXPECT_EQ(shown.contacts[0].piece_a, 7u);
  EXPECT_EQ(shown.contacts[0].level_b, 2u);
  EXPECT_EQ(shown.force_N[5].x, 0.5);
}

TEST_F(ReportContacts, ticks_between_frames_are_passed_over) {
  for (TickRow& tick : line_.ticks) tick.contacts = 1;
  std::string rows;
  for (std::size_t tick = 0; tick < kTicks; ++tick) rows += row(tick, 1e-5 * double(tick));
  const ShownContacts shown = read(rows, 3);
  ASSERT_EQ(shown.contacts.size(), 3u);
  EXPECT_DOUBLE_EQ(shown.contacts[2].distance_m, 4e-5);
}

TEST_F(ReportContacts, no_frame_has_more_than_its_share) {
  line_.ticks[0].contacts = 200;
  std::string rows;
  for (int i = 0; i < 200; ++i) rows += row(0, 1e-6 * i);
  const ShownContacts shown = read(rows);
  EXPECT_EQ(shown.contacts.size(), kMaxContactsOfFrame);
  EXPECT_EQ(shown.found[0], 200u);
}

TEST_F(ReportContacts, contacts_of_another_replay_are_refused_with_their_line) {
  line_.ticks[1].contacts = 2;
  const std::string said = test::failure_of([&] { (void)read(row(1, 1e-4)); });
  EXPECT_NE(said.find("tick 1 has 1 contacts here and 2"), std::string::npos) << said;
  EXPECT_NE(said.find("contacts.csv:"), std::string::npos) << said;
}

TEST_F(ReportContacts, rows_that_are_none_are_refused) {
  line_.ticks[0].contacts = 1;
  const std::string good = row(0, 1e-4);
  EXPECT_EQ(test::failure_of([&] { (void)read(good); }), "");
  for (const std::string& bad :
       {good.substr(0, 20), "x" + good, row(0, 1e-4, "1"), row(0, 1e-4, "-1"), row(0, 1e-4, "nan"),
        good.substr(0, good.size() - 1) + ",\n", std::string("\n")}) {
    EXPECT_NE(test::failure_of([&] { (void)read(bad); }), "") << bad;
  }
  view_.contacts = folder_.write("contacts.csv", "another,header\n");
  EXPECT_NE(test::failure_of([&] {
              (void)read_shown_contacts(view_, line_, frames_of(kTicks));
            }).find("not a table of contacts"),
            std::string::npos);
}

TEST_F(ReportContacts, replayed_contacts_are_those_of_the_frames_poses) {
  const ShownContacts shown = replay_shown_contacts(view_, frames_of(kTicks, 3), {});
  ASSERT_EQ(shown.found.size(), 3u);  // gaps of 1, 0.6 and 0.2 mm against a delta of 0.5 mm
  EXPECT_EQ(shown.found[0], 0u);
  EXPECT_EQ(shown.found[1], 0u);
  ASSERT_GT(shown.found[2], 0u);
  EXPECT_NEAR(shown.contacts.front().distance_m, 2e-4, 1e-8);
  EXPECT_EQ(norm(shown.force_N[0]), 0.0);
  EXPECT_GT(shown.force_N[2].x, 0.0);
}

}  // namespace
}  // namespace palpate::cli
