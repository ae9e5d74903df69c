// SPDX-License-Identifier: GPL-3.0-or-later
// The executable's frame: help, version, and what every sub-command does with a wrong command line.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "../support/process.hpp"

namespace palpate {
namespace {

test::Outcome palpate(std::vector<std::string> arguments, const std::filesystem::path& out = {}) {
  arguments.emplace(arguments.begin(), PALPATE_EXECUTABLE);
  return test::run(arguments, out);
}

/// The names that --help lists.
std::vector<std::string> commands() {
  std::istringstream help(palpate({"--help"}).out);
  std::vector<std::string> names;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (listed && line.empty()) break;
    // Lines that continue a description are indented further.
    if (listed && line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
    listed = listed || line == "Subcommands:";
  }
  return names;
}

void expect_usage_error(const test::Outcome& outcome, const std::string& what) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.err.find("palpate: error: "), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

TEST(Frame, Version_names_formats_and_build) {
  const test::Outcome outcome = palpate({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out.find("palpate " PALPATE_VERSION ", image format 3.0, "), 0u) << outcome.out;
  EXPECT_NE(outcome.out.find(", float32 geometry, double solves\n"), std::string::npos)
      << outcome.out;
}

TEST(Frame, Help_everywhere_with_exit_statuses) {
  const std::vector<std::string> names = commands();
  EXPECT_FALSE(names.empty());
  for (const std::string& name : names) {
    const test::Outcome outcome = palpate({name, "--help"});
    EXPECT_EQ(outcome.status, 0) << name;
    EXPECT_NE(outcome.out.find("Exit status: 0 done; 2 "), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, "");
  }
}

TEST(Frame, Wrong_command_line_exits_2_with_one_line) {
  expect_usage_error(palpate({}), "see 'palpate --help'");
  expect_usage_error(palpate({"feel"}), "unknown command or option 'feel'");
  expect_usage_error(palpate({"--feel"}), "unknown command or option '--feel'");
}

TEST(Frame, Unknown_option_exits_2_in_every_command) {
  for (const std::string& name : commands())
    expect_usage_error(palpate({name, "--feel"}), "palpate " + name + " --help");
}

TEST(Frame, Standard_output_that_is_full_exits_1) {
  const test::Outcome outcome = palpate({"--version"}, "/dev/full");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err.find("palpate: error: cannot write: standard output: "), 0u) << outcome.err;
}

TEST(Frame, Reader_that_leaves_is_no_error) {
  const test::Outcome outcome = test::run(
      {"/bin/sh", "-c", "{ sleep 0.2; \"$0\" --help; echo $? >&2; } | true", PALPATE_EXECUTABLE});
  EXPECT_EQ(outcome.err, "0\n");
}

}  // namespace
}  // namespace palpate
