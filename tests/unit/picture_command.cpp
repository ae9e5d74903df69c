// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate inspect --picture` as a process.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"

namespace palpate::test {
namespace {

class PictureCommand : public testing::Test {
 protected:
  PictureCommand() {
    const AlignedBytes bytes = seal(parts_of({box_part({0, 0, 0}, {0.5f, 0.25f, 0.125f})}));
    folder_.write("box.palp",
                  {static_cast<const char*>(static_cast<const void*>(bytes.data())), bytes.size()});
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] Outcome inspect(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {PALPATE_EXECUTABLE, "inspect", path("box.palp")});
    return run(arguments);
  }
  void expect_usage_error(const Outcome& outcome, const std::string& words) const {
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("out.png")));
  }

  TemporaryFolder folder_;
};

TEST_F(PictureCommand, Writes_a_png_beside_what_it_prints) {
  const Outcome outcome = inspect({"--picture", path("out.png")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("Orig. Tris"), std::string::npos);
  EXPECT_EQ(read_file(path("out.png")).rfind("\x89PNG\r\n\x1a\n", 0), 0u);
}

TEST_F(PictureCommand, Looks_from_where_it_is_told) {
  ASSERT_EQ(inspect({"--picture", path("a.png")}).status, 0);
  ASSERT_EQ(inspect({"--picture", path("b.png"), "--from", "1", "-2", "1.5"}).status, 0);
  ASSERT_EQ(inspect({"--picture", path("c.png"), "--from", "-1", "0", "-1"}).status, 0);
  EXPECT_EQ(read_file(path("a.png")), read_file(path("b.png")));
  EXPECT_NE(read_file(path("a.png")), read_file(path("c.png")));
}

TEST_F(PictureCommand, No_direction_is_refused) {
  const std::string out = path("out.png");
  expect_usage_error(inspect({"--picture", out, "--from", "0", "0", "0"}), "not zero");
  expect_usage_error(inspect({"--picture", out, "--from", "1", "nan", "0"}), "--from");
  expect_usage_error(inspect({"--picture", out, "--from", "1", "2"}), "--from");
  expect_usage_error(inspect({"--from", "1", "2", "3"}), "--picture");
}

TEST_F(PictureCommand, Name_of_another_format_is_refused) {
  expect_usage_error(inspect({"--picture", path("out.jpg")}), "another format");
  EXPECT_FALSE(std::filesystem::exists(path("out.jpg")));
}

TEST_F(PictureCommand, A_place_that_cannot_be_written_leaves_nothing) {
  const Outcome outcome = inspect(
      {"--export-lod", "0", "-o", path("level.ply"), "--picture", path("no/such/folder.png")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(path("level.ply")));
}

}  // namespace
}  // namespace palpate::test
