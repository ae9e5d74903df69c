// SPDX-License-Identifier: GPL-3.0-or-later
// Time of single calls of some ten nanoseconds.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace palpate::bench {

/// Reads the processor's counter; what stands before it is finished and what follows has not begun.
inline std::uint64_t read_ticks() noexcept {
#if defined(__x86_64__)
  _mm_lfence();
  const std::uint64_t ticks = __rdtsc();
  _mm_lfence();
  return ticks;
#elif defined(__aarch64__)
  std::uint64_t ticks = 0;
  __asm__ volatile("isb; mrs %0, cntvct_el0; isb" : "=r"(ticks)::"memory");
  return ticks;
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                                    std::chrono::nanoseconds(1));
#endif
}

/// Mean of the middle half. The counter may advance in coarse steps (10 ns on some machines), which
/// a median would keep and a mean does not; what interrupts a program falls into the upper quarter.
/// @param values  at least one; sorted here
inline double middle_mean(std::span<std::uint32_t> values) {
  std::sort(values.begin(), values.end());
  const std::size_t quarter = values.size() / 4;
  const auto middle = values.subspan(quarter, values.size() - 2 * quarter);
  return std::accumulate(middle.begin(), middle.end(), 0.0) / static_cast<double>(middle.size());
}

/// What a tick is worth, and what reading the counter itself costs.
struct Stopwatch {
  double ns_per_tick = 1;
  double overhead = 0;  ///< ticks between two readings with nothing between them

  [[nodiscard]] double ns(double ticks) const { return ns_per_tick * (ticks - overhead); }
};

/// Takes a tenth of a second.
inline Stopwatch calibrated() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const std::uint64_t first = read_ticks();
  std::vector<std::uint32_t> empty;
  while (Clock::now() - begin < std::chrono::milliseconds(100)) {
    const std::uint64_t t = read_ticks();
    empty.push_back(static_cast<std::uint32_t>(read_ticks() - t));
  }
  const double ns = std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
  Stopwatch s;
  s.ns_per_tick = ns / static_cast<double>(read_ticks() - first);
  s.overhead = middle_mean(empty);
  return s;
}

}  // namespace palpate::bench
