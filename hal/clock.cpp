// SPDX-License-Identifier: Apache-2.0
#include "hal/clock.hpp"

#include <cerrno>
#include <ctime>

namespace palpate::hal {
namespace {

constexpr std::uint64_t kNsPerSecond = 1'000'000'000;

}  // namespace

std::uint64_t MonotonicClock::now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * kNsPerSecond +
         static_cast<std::uint64_t>(now.tv_nsec);
}

void MonotonicClock::sleep_until(std::uint64_t time_ns) noexcept {
  timespec until{};
  until.tv_sec = static_cast<std::time_t>(time_ns / kNsPerSecond);
  until.tv_nsec = static_cast<long>(time_ns % kNsPerSecond);
  // A signal ends the sleep early; the time is absolute, so sleeping again adds nothing.
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace palpate::hal
