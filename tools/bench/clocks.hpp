// SPDX-License-Identifier: GPL-3.0-or-later
// The clocks that benchmarks read, in nanoseconds. The signatures are those of Budget::clock_ns.
#pragma once

#include <time.h>

#include <cstdint>

namespace palpate::bench {

inline std::uint64_t read_ns(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000 +
         static_cast<std::uint64_t>(t.tv_nsec);
}

/// What the thread has had of a processor: other programs do not count. Reading it is a system
/// call.
inline std::uint64_t processor_ns(void* = nullptr) noexcept {
  return read_ns(CLOCK_THREAD_CPUTIME_ID);
}

/// Time as it passes; monotonic. Reading it is cheap.
inline std::uint64_t wall_ns(void* = nullptr) noexcept { return read_ns(CLOCK_MONOTONIC); }

}  // namespace palpate::bench
