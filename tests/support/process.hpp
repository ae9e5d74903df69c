// SPDX-License-Identifier: Apache-2.0
// Runs a program and gives what it said.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "temporary_folder.hpp"

extern char** environ;

namespace palpate::test {

struct Outcome {
  int status = -1;  ///< exit status; 128 + n where signal n ended it
  std::string out, err;
};

/// @param out  where standard output goes; empty: into the outcome
inline Outcome run(std::vector<std::string> command, const std::filesystem::path& out = {}) {
  const TemporaryFolder folder;
  const std::string out_file = out.empty() ? folder.path() / "out" : out,
                    err_file = folder.path() / "err";
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, out_file.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&files, 2, err_file.c_str(), O_WRONLY | O_CREAT, 0600);

  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int error =
      ::posix_spawn(&process, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  EXPECT_EQ(error, 0) << arguments[0];
  if (error != 0) return {};
  int status = 0;
  EXPECT_EQ(::waitpid(process, &status, 0), process);

  Outcome outcome;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (out.empty()) outcome.out = read_file(out_file);
  outcome.err = read_file(err_file);
  return outcome;
}

/// The same with another current folder.
inline Outcome run_in(const std::filesystem::path& folder, std::vector<std::string> command) {
  command.insert(command.begin(), {"/usr/bin/env", "--chdir=" + folder.string()});
  return run(std::move(command));
}

}  // namespace palpate::test
