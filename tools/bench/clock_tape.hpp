// SPDX-License-Identifier: GPL-3.0-or-later
// A clock for Budget::clock_ns whose readings can be told again: from the same state, they lead a
// tick through the same work, however long it takes the second time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "tools/palpate/clocks.hpp"

namespace palpate::bench {

class ClockTape {
 public:
  /// The next tick is told the time as it passes.
  void record() {
    told_.clear();
    asked_.clear();
    playing_ = false;
  }
  /// The next tick is told what the recorded one was.
  void play() {
    asked_.clear();
    playing_ = true;
  }
  /// What the recorded tick was told.
  [[nodiscard]] const std::vector<std::uint64_t>& told_ns() const { return told_; }
  /// When the last tick asked.
  [[nodiscard]] const std::vector<std::uint64_t>& asked_ns() const { return asked_; }

  /// @param tape  a ClockTape. A tick that asks more often than the recorded one did has not done
  ///              the same work: a bug, which ends the program
  static std::uint64_t read(void* tape) noexcept {
    return static_cast<ClockTape*>(tape)->next_ns();
  }

 private:
  std::uint64_t next_ns() {
    const std::uint64_t now_ns = cli::wall_ns();
    const std::size_t i = asked_.size();
    asked_.push_back(now_ns);
    if (!playing_) told_.push_back(now_ns);
    if (i >= told_.size()) std::abort();
    return told_[i];
  }

  std::vector<std::uint64_t> told_, asked_;
  bool playing_ = false;
};

}  // namespace palpate::bench
