// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate run --view` as a process, while a test looks at its page.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "process.hpp"
#include "temporary_folder.hpp"

namespace palpate::test {

class LiveRun {
 public:
  explicit LiveRun(std::vector<std::string> command) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, out_.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&files, 2, err_.c_str(), O_WRONLY | O_CREAT, 0600);
    std::vector<char*> arguments;
    for (std::string& argument : command) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    EXPECT_EQ(::posix_spawn(&process_, arguments[0], &files, nullptr, arguments.data(), environ),
              0);
    posix_spawn_file_actions_destroy(&files);
  }
  ~LiveRun() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  LiveRun(LiveRun&&) = delete;
  LiveRun& operator=(LiveRun&&) = delete;

  /// What it said; empty where it ended without, or after 10 s.
  [[nodiscard]] std::string address() const {
    constexpr std::string_view kBefore = "Live view: ";
    for (int i = 0; i < 1000; ++i) {
      const std::string err = read_file(err_);
      const std::size_t at = err.find(kBefore);
      const std::size_t end = at == std::string::npos ? at : err.find('\n', at);
      if (end != std::string::npos) {
        return err.substr(at + kBefore.size(), end - at - kBefore.size());
      }
      if (err.find("palpate: error") != std::string::npos) return "";
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return "";
  }

  /// Waits for its end.
  Outcome finish() {
    int status = 0;
    EXPECT_EQ(::waitpid(std::exchange(process_, -1), &status, 0) > 0, true);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(out_),
            read_file(err_)};
  }

 private:
  TemporaryFolder folder_;
  std::string out_ = folder_.path() / "out", err_ = folder_.path() / "err";
  pid_t process_ = -1;
};

}  // namespace palpate::test
