// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kSilent(1000);        // shorter work shows nothing
constexpr milliseconds kTerminalEvery(100);  // redraws of the bar
constexpr milliseconds kLineEvery(5000);     // plain lines within a stage
constexpr int kBarWidth = 30;

std::string time_left(Clock::duration spent, double done) {
  if (done < 0.01) return "";
  const double left_s = std::chrono::duration<double>(spent).count() * (1 - done) / done;
  return ", " + std::to_string(std::lround(left_s)) + " s left";
}

class Printer {
 public:
  Printer() : terminal_(::isatty(STDERR_FILENO) == 1) {}
  ~Printer() {
    if (terminal_ && shown_) std::fputs("\r\033[K", stderr);
  }
  Printer(const Printer&) = delete;
  Printer& operator=(const Printer&) = delete;

  void show(std::string_view stage, double done) {
    const Clock::time_point now = Clock::now();
    const bool new_stage = stage != stage_;
    // Stages that go on where the one before ended are one piece of work.
    if (done < done_ / 2) work_start_ = now;
    done_ = done;
    stage_ = stage;
    if (now - start_ < kSilent) return;
    const milliseconds every = terminal_ ? kTerminalEvery : new_stage ? kSilent : kLineEvery;
    if (shown_ && now - last_ < every) return;
    last_ = now;
    shown_ = true;
    print(std::clamp(done, 0.0, 1.0), now - work_start_);
  }

 private:
  void print(double done, Clock::duration spent) const {
    const int percent = static_cast<int>(100 * done);
    const std::string left = time_left(spent, done);
    if (!terminal_) {
      std::fprintf(stderr, "palpate: %s: %d %%%s\n", stage_.c_str(), percent, left.c_str());
      return;
    }
    const auto filled = static_cast<std::size_t>(kBarWidth * done);
    const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
    std::fprintf(stderr, "\r[%s] %3d %% %s%s\033[K", bar.c_str(), percent, stage_.c_str(),
                 left.c_str());
    std::fflush(stderr);
  }

  bool terminal_;
  bool shown_ = false;
  std::string stage_;
  double done_ = 0;
  Clock::time_point start_ = Clock::now(), work_start_ = start_, last_ = start_;
};

}  // namespace

bake::Progress progress(bool quiet) {
  if (quiet) return [](std::string_view, double) {};
  const auto printer = std::make_shared<Printer>();
  return [printer](std::string_view stage, double done) { printer->show(stage, done); };
}

}  // namespace palpate::cli
