// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate report` as a process.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/process.hpp"
#include "tests/unit/report_support.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

class Report : public ::testing::Test {
 protected:
  Report() {
    folder_.write("cube.palp", test::cube_image());
    folder_.write("cubes.toml", test::cube_scene());
    folder_.write("poses.csv", test::cube_poses(6));
    const test::Outcome outcome =
        test::run({PALPATE_EXECUTABLE, "replay", at("cubes.toml"), "--poses", at("poses.csv"), "-o",
                   at("ticks.csv"), "--contacts", at("contacts.csv"), "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }

  [[nodiscard]] std::string at(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  /// A build without node has no page; the command then refuses, which a test below shows.
  static bool has_page() {
    return fs::exists(fs::path(PALPATE_EXECUTABLE).parent_path() / "report.html");
  }

  test::Outcome report(const std::string& source, const std::string& executable = {}) {
    return test::run({executable.empty() ? PALPATE_EXECUTABLE : executable, "report", source, "-o",
                      at("report.html"), "--quiet"});
  }

  void expect_refusal(const test::Outcome& outcome, int status, const std::string& what) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.err.find("palpate: error: "), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    EXPECT_FALSE(fs::exists(at("report.html")));
    EXPECT_EQ(folder_.files(), 6u);  // what the set-up made: no temporary ones
  }

  test::TemporaryFolder folder_;
};

TEST_F(Report, of_a_replay_is_one_page_that_holds_its_data_and_names_no_other_file) {
  if (!has_page()) GTEST_SKIP() << "built without the page";
  const test::Outcome outcome = report(folder_.path().string());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string page = test::read_file(at("report.html"));
  const std::string begin = "<script id=\"data\" type=\"application/json\">";
  const std::size_t from = page.find(begin) + begin.size();
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(data.at("lines").at(0).at("name"), "ticks");
  EXPECT_EQ(data.at("view").at("bodies").size(), 2u);
  EXPECT_EQ(data.at("view").at("origin"), "Contacts as contacts.csv recorded them.");
  EXPECT_EQ(page.find("@PALPATE"), std::string::npos);
  EXPECT_EQ(page.find("src=\""), std::string::npos);
  EXPECT_EQ(page.find("<link rel=\"stylesheet\""), std::string::npos);
}

TEST_F(Report, without_a_page_is_refused_with_the_fix) {
  const std::string alone = at("palpate");
  fs::copy_file(PALPATE_EXECUTABLE, alone);
  const test::Outcome outcome = report(folder_.path().string(), alone);
  fs::remove(alone);
  expect_refusal(outcome, 1, "report_bundle");
}

TEST_F(Report, of_what_is_no_source_is_refused) {
  if (!has_page()) GTEST_SKIP() << "built without the page";
  expect_refusal(report(at("none")), 3, "no such folder or trace");
  expect_refusal(report(at("poses.csv")), 3, "not a trace");
}

TEST_F(Report, of_mixed_tables_is_refused) {
  if (!has_page()) GTEST_SKIP() << "built without the page";
  const std::string contacts = test::read_file(at("contacts.csv"));
  folder_.write("contacts.csv", contacts.substr(0, contacts.find('\n') + 1));
  expect_refusal(report(folder_.path().string()), 3, "in its table of ticks");
}

}  // namespace
}  // namespace palpate
