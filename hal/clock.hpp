// SPDX-License-Identifier: Apache-2.0
// Time as the loop and the device threads see it, so that both also run in virtual time.
#pragma once

#include <cstdint>

namespace palpate::hal {

class Clock {
 public:
  virtual ~Clock() = default;
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  Clock(Clock&&) = delete;
  Clock& operator=(Clock&&) = delete;

  /// Nanoseconds since an unspecified start; never runs backwards.
  [[nodiscard]] virtual std::uint64_t now_ns() noexcept = 0;

  /// Returns at or after the given time; at once where it has passed.
  virtual void sleep_until(std::uint64_t time_ns) noexcept = 0;
};

/// CLOCK_MONOTONIC, with absolute sleeps (clock_nanosleep with TIMER_ABSTIME): the one way of
/// waiting that real-time kernels vouch for (Linux documentation, trace/rv/monitor_rtapp).
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] std::uint64_t now_ns() noexcept override;
  void sleep_until(std::uint64_t time_ns) noexcept override;
};

}  // namespace palpate::hal
