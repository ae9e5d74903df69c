// SPDX-License-Identifier: Apache-2.0
// When the refinement of a tick has to end.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/base/meter.hpp"

namespace palpate {

/// The clock is read after this many units: with what is done in one go, 40 at most.
inline constexpr std::uint64_t kUnitsPerReading = 30;

/// When a search has to end.
class Pace {
 public:
  explicit Pace(Meter& meter) noexcept : meter_(meter) {}
  void charge(std::uint64_t units) noexcept { meter_.charge(units); }
  /// See Meter::expect_contacts().
  void expect_contacts(std::uint64_t contacts) noexcept { meter_.expect_contacts(contacts); }
  /// go_on() is false after so many units from now on, too, until no_limit() is called.
  void limit(std::uint64_t units) noexcept { limit_ = meter_.used() + units; }
  void no_limit() noexcept { limit_ = std::numeric_limits<std::uint64_t>::max(); }
  /// Once more is to be had.
  void resume() noexcept {
    units_ended_ = time_ended_ = false;
    next_reading_ = 0;
  }
  /// False from the moment at which the budget is used up.
  [[nodiscard]] bool go_on() noexcept {
    if (units_ended_ || time_ended_ || meter_.used() >= limit_) return false;
    units_ended_ = meter_.out_of_units();
    if (meter_.used() >= next_reading_) {
      next_reading_ = meter_.used() + kUnitsPerReading;
      time_ended_ = meter_.out_of_time();
    }
    return !units_ended_ && !time_ended_;
  }
  /// The same for something that takes so long, about, and cannot be left half done.
  [[nodiscard]] bool go_on_for(std::uint64_t ns) noexcept {
    time_ended_ = time_ended_ || !meter_.has_time_for(ns);
    return go_on();
  }
  [[nodiscard]] std::uint64_t elapsed_ns() const noexcept { return meter_.elapsed_ns(); }
  [[nodiscard]] bool units_ended() const noexcept { return units_ended_; }
  [[nodiscard]] bool time_ended() const noexcept { return time_ended_; }
  [[nodiscard]] std::uint64_t used() const noexcept { return meter_.used(); }

 private:
  Meter& meter_;
  std::uint64_t next_reading_ = 0;
  std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
  bool units_ended_ = false;
  bool time_ended_ = false;
};

}  // namespace palpate
