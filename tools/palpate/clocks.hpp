// SPDX-License-Identifier: GPL-3.0-or-later
// The clocks that replays and benchmarks read, in nanoseconds. The functions have the signature of
// Budget::clock_ns.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdint>

namespace palpate::cli {

inline std::uint64_t read_ns(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000 +
         static_cast<std::uint64_t>(t.tv_nsec);
}

/// Time as it passes; monotonic. Reading it is cheap.
inline std::uint64_t wall_ns(void* = nullptr) noexcept { return read_ns(CLOCK_MONOTONIC); }

/// What the thread has had of a processor: other programs do not count. Reading it is a system
/// call, which takes as long as several convex queries.
inline std::uint64_t processor_ns(void* = nullptr) noexcept {
  return read_ns(CLOCK_THREAD_CPUTIME_ID);
}

/// The same, cheap enough to be read within ticks: time as it passes, and where it jumps, what the
/// thread has had of the jump. So it is fast by as much as a thread is away in shorter turns.
class ProcessorClock {
 public:
  [[nodiscard]] std::uint64_t now_ns() noexcept {
    const std::uint64_t wall = wall_ns();
    std::uint64_t passed = wall - wall_ns_;
    if (passed > kJump_ns) {
      const std::uint64_t thread = processor_ns();
      const std::uint64_t had = thread - thread_ns_;
      passed = std::min(passed, had > counted_ns_ ? had - counted_ns_ : 0);
      thread_ns_ = thread;
      counted_ns_ = 0;
    } else {
      counted_ns_ += passed;
    }
    wall_ns_ = wall;
    return now_ns_ += passed;
  }

  /// @param clock  a ProcessorClock
  static std::uint64_t read(void* clock) noexcept {
    return static_cast<ProcessorClock*>(clock)->now_ns();
  }

 private:
  static constexpr std::uint64_t kJump_ns = 10'000;

  std::uint64_t wall_ns_ = 0;     ///< at the last reading
  std::uint64_t now_ns_ = 0;      ///< what it said
  std::uint64_t thread_ns_ = 0;   ///< at the last jump
  std::uint64_t counted_ns_ = 0;  ///< since then
};

}  // namespace palpate::cli
