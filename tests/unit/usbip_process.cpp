// SPDX-License-Identifier: GPL-3.0-or-later
// palpate-sim as a process; its clients are the usbip tool of the Linux kernel, and `palpate run`.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/cube_scene.hpp"
#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"

namespace palpate {
namespace {

/// palpate-sim on a free port, until this ends.
class Simulator {
 public:
  explicit Simulator(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {PALPATE_SIM, "--port", "0"});
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[1], 1);
    EXPECT_EQ(::posix_spawn(&process_, words[0], &files, nullptr, words.data(), environ), 0);
    posix_spawn_file_actions_destroy(&files);
    ::close(ends[1]);
    char letter = 0;
    while (::read(ends[0], &letter, 1) == 1 && letter != '\n') greeting_ += letter;
    said_ = ends[0];  // open: it goes on saying what happens
  }
  ~Simulator() {
    ::kill(process_, SIGTERM);
    int status = -1;
    ::waitpid(process_, &status, 0);
    EXPECT_EQ(status, 0);
    ::close(said_);
  }
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;
  Simulator(Simulator&&) = delete;
  Simulator& operator=(Simulator&&) = delete;

  /// Of "A simulated device, usb:SIM0001, on 127.0.0.1:34567. ..."
  [[nodiscard]] std::string port() const {
    const std::size_t end = greeting_.find(". Where");
    const std::size_t colon = greeting_.rfind(':', end);
    return greeting_.substr(colon + 1, end - colon - 1);
  }

 private:
  pid_t process_ = -1;
  int said_ = -1;
  std::string greeting_;
};

test::Outcome list(const Simulator& simulator) {
  return test::run({USBIP_TOOL, "--tcp-port", simulator.port(), "list", "-r", "127.0.0.1"});
}

TEST(PalpateSim, usbip_lists_a_device_of_the_open_protocol_with_both_interfaces) {
  const test::TemporaryFolder folder;
  const Simulator simulator({"--flash", folder.path() / "flash"});
  const test::Outcome outcome = list(simulator);
  EXPECT_NE(outcome.out.find("1-1: "), std::string::npos) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("1209:0001"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("ff/50/41"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("fe/01/02"), std::string::npos) << outcome.out;
}

TEST(PalpateSim, usbip_lists_a_falcon) {
  const Simulator simulator({"--device", "falcon"});
  EXPECT_NE(list(simulator).out.find("0403:cb48"), std::string::npos);
}

TEST(PalpateSim, run_takes_the_device_without_rights_and_leaves_it_for_the_next) {
  const test::TemporaryFolder folder;
  folder.write("cube.palp", test::cube_image());
  const std::string scene = folder.write("scene.toml", test::cube_loop_scene());
  const Simulator simulator({"--scene", scene});
  for (int visit = 0; visit < 2; ++visit) {
    const test::Outcome outcome =
        test::run({PALPATE_EXECUTABLE, "run", scene, "--device",
                   "tcp:127.0.0.1:" + simulator.port(), "--seconds", "1", "--json"});
    ASSERT_TRUE(outcome.status == 0 || outcome.status == 4 || outcome.status == 5) << outcome.err;
    ASSERT_FALSE(outcome.out.empty()) << outcome.err;
    const auto j = nlohmann::json::parse(outcome.out);
    if (!j["faults"].empty()) GTEST_SKIP() << "the machine is too busy to hold the loop up";
    EXPECT_GT(j["ticks"], 100);
#ifndef PALPATE_SANITIZED
    EXPECT_EQ(j["allocations"], 0);
#endif
  }
}

TEST(PalpateSim, wrong_options_are_a_usage_error_in_one_line) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"--device", "pencil"}, {"--address", "here"}, {"--rate", "0"}, {"--scene", "none"}}) {
    std::vector<std::string> command{PALPATE_SIM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const test::Outcome outcome = test::run(command);
    EXPECT_EQ(outcome.status, 2) << arguments[0];
    EXPECT_EQ(outcome.err.rfind("palpate-sim: error: ", 0), 0u) << outcome.err;
  }
}

}  // namespace
}  // namespace palpate
