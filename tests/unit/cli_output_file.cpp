// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/output_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "../support/temporary_folder.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/file_format.hpp"

namespace palpate::cli {
namespace {

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

class OutputFiles : public ::testing::Test {
 protected:
  std::filesystem::path at(const std::string& name) const { return folder_.path() / name; }
  test::TemporaryFolder folder_;
};

TEST_F(OutputFiles, Commit_replaces_the_target) {
  folder_.write("x", "old");
  write_file(at("x"), "new");
  EXPECT_EQ(test::read_file(at("x")), "new");
  EXPECT_EQ(folder_.files(), 1u);
}

TEST_F(OutputFiles, Without_commit_nothing_changes) {
  folder_.write("x", "old");
  {
    const OutputFile file(at("x"), bytes("new"));
    EXPECT_EQ(test::read_file(at("x")), "old");
    EXPECT_EQ(folder_.files(), 2u);
  }
  EXPECT_EQ(test::read_file(at("x")), "old");
  EXPECT_EQ(folder_.files(), 1u);
}

TEST_F(OutputFiles, Two_at_a_time_have_their_own_temporaries) {
  OutputFile first(at("a"), bytes("1"));
  OutputFile second(at("b"), bytes("2"));
  first.commit();
  second.commit();
  EXPECT_EQ(test::read_file(at("a")), "1");
  EXPECT_EQ(test::read_file(at("b")), "2");
  EXPECT_EQ(folder_.files(), 2u);
}

TEST_F(OutputFiles, Appended_parts_make_one_file) {
  OutputFile file(at("x"));
  file.append("one ");
  file.append("two");
  EXPECT_FALSE(std::filesystem::exists(at("x")));
  file.commit();
  EXPECT_EQ(test::read_file(at("x")), "one two");
}

TEST_F(OutputFiles, Link_stays_and_its_file_is_replaced) {
  folder_.write("x", "old");
  std::filesystem::create_symlink("x", at("link"));
  write_file(at("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(at("link")));
  EXPECT_EQ(test::read_file(at("x")), "new");
  EXPECT_EQ(folder_.files(), 2u);
}

TEST_F(OutputFiles, Device_is_written_in_place) {
  write_file("/dev/null", "text");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(OutputFiles, Place_is_tried_before_the_work_and_left_as_it_was) {
  folder_.write("x", "old");
  require_writable(at("x"));
  require_writable(at("y"));
  EXPECT_EQ(test::read_file(at("x")), "old");
  EXPECT_EQ(folder_.files(), 1u);
  EXPECT_THROW(require_writable(at("no/folder")), Failure);
  EXPECT_THROW(require_writable(folder_.path()), Failure);
}

TEST_F(OutputFiles, Longest_name_is_written) {
  const std::string name(255, 'n');
  write_file(at(name), "text");
  EXPECT_EQ(test::read_file(at(name)), "text");
}

TEST_F(OutputFiles, Target_that_cannot_be_is_refused_and_leaves_nothing) {
  std::filesystem::create_directory(at("folder"));
  for (const auto& target : {at("folder"), at("absent") / "x", std::filesystem::path("/dev/full"),
                             std::filesystem::path()}) {
    try {
      write_file(target, "text");
      ADD_FAILURE() << "accepted: " << target;
    } catch (const Failure& e) {
      EXPECT_EQ(e.code, kOther) << e.what();
    }
  }
  EXPECT_EQ(folder_.files(), 1u);
}

TEST(NamesOfFiles, of_another_format_are_wrong_and_say_the_right_one) {
  EXPECT_EQ(wrong_name("part.ply", ".ply"), "");
  EXPECT_EQ(wrong_name("PART.PLY", ".ply"), "");
  EXPECT_EQ(wrong_name("part", ".palp"), "");
  EXPECT_EQ(wrong_name("part.v2", ".palp"), "");
  EXPECT_EQ(wrong_name("image.o", ".elf"), "");  // what linkers call it
  for (const char* name : {"part.stl", "run.csv", "a.b/part.STL", "x.trace"}) {
    EXPECT_NE(wrong_name(name, ".palp").find(".palp'"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace palpate::cli
