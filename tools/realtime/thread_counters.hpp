// SPDX-License-Identifier: GPL-3.0-or-later
// What the calling thread did that a real-time thread must not do: allocator calls and page faults,
// counted since it started.
//
// Allocator calls are counted by an interposer: malloc, free and their kin (which operator new and
// delete use) are replaced in every executable that links this. It is left out under the
// sanitizers, which bring an allocator of their own, and where the C library is not glibc: then the
// number is absent, never a false zero.
#pragma once

#include <cstdint>
#include <optional>

namespace palpate::realtime {

struct ThreadCounters {
  std::optional<std::uint64_t>
      allocator_calls;  ///< malloc, calloc, realloc, free and so on; absent where not counted
  std::uint64_t minor_faults = 0;  ///< pages mapped on first touch
  std::uint64_t major_faults = 0;  ///< pages read from a disk
};

/// The calling thread's counters. One system call, no allocation.
[[nodiscard]] ThreadCounters thread_counters() noexcept;

/// How far counters have moved from one reading to a later one of the same thread.
[[nodiscard]] ThreadCounters operator-(const ThreadCounters& later,
                                       const ThreadCounters& earlier) noexcept;

}  // namespace palpate::realtime
