// SPDX-License-Identifier: GPL-3.0-or-later
// Time of single calls of some ten nanoseconds.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace palpate::bench {

/// Reads the processor's counter once all that stands before it is done; what follows may begin
/// meanwhile, as it may without a stopwatch.
inline std::uint64_t read_ticks() noexcept {
#if defined(__x86_64__)
  unsigned processor = 0;
  return __rdtscp(&processor);
#elif defined(__aarch64__)
  std::uint64_t ticks = 0;
  __asm__ volatile("isb; mrs %0, cntvct_el0" : "=r"(ticks)::"memory");
  return ticks;
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                                    std::chrono::nanoseconds(1));
#endif
}

/// Mean of the values up to twice their median: what interrupts a program lies above. Not the
/// median itself, for the counter may advance in coarse steps (10 ns on some machines), which only
/// a mean sees through.
/// @param values  at least one; reordered
inline double undisturbed_mean(std::span<std::uint32_t> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const std::uint32_t most = 2 * *middle;
  double sum = 0;
  std::size_t count = 0;
  for (const std::uint32_t v : values) {
    if (v > most) continue;
    sum += v;
    ++count;
  }
  return sum / static_cast<double>(count);
}

/// What a tick is worth, and what reading the counter itself costs.
struct Stopwatch {
  double ns_per_tick = 1;
  double overhead = 0;  ///< ticks from one reading to the next with nothing between them

  [[nodiscard]] double ns(double ticks) const { return ns_per_tick * (ticks - overhead); }
};

/// Takes a tenth of a second.
inline Stopwatch calibrated() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const std::uint64_t first = read_ticks();
  std::vector<std::uint32_t> empty;
  while (Clock::now() - begin < std::chrono::milliseconds(100)) {
    std::uint64_t last = read_ticks();
    for (int i = 0; i < 100; ++i) {
      const std::uint64_t now = read_ticks();
      empty.push_back(static_cast<std::uint32_t>(now - last));
      last = now;
    }
  }
  const double ns = std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
  Stopwatch s;
  s.ns_per_tick = ns / static_cast<double>(read_ticks() - first);
  s.overhead = undisturbed_mean(empty);
  return s;
}

}  // namespace palpate::bench
