// SPDX-License-Identifier: Apache-2.0
// Counts what ticks do, or nothing: one switch for the whole library.
#pragma once

#include <type_traits>

#include "rt_core/base/meter.hpp"
#include "rt_core/counters.hpp"

#ifndef PALPATE_COUNTERS
#define PALPATE_COUNTERS 0
#endif

namespace palpate {

class CountingTally {
 public:
  void begin_tick() noexcept {
    ++counters_.ticks;
    last_ns_ = 0;
  }

  /// Charges the time since the last lap to a stage.
  void lap(Stage stage, const Meter& meter) noexcept { lap(stage, meter.elapsed_ns()); }
  /// @param now_ns  Meter::elapsed_ns(), where the clock has just been read
  void lap(Stage stage, std::uint64_t now_ns) noexcept {
    counters_.stage_ns[static_cast<std::uint32_t>(stage)] += now_ns - last_ns_;
    last_ns_ = now_ns;
  }

  /// @param change  a generic function of the counters
  template <class Change>
  void count(Change change) noexcept {
    change(counters_);
  }

  [[nodiscard]] const Counters* counters() const noexcept { return &counters_; }
  void reset() noexcept { *this = {}; }

 private:
  Counters counters_;
  std::uint64_t last_ns_ = 0;
};

/// Leaves no code and no memory: what would change counters is never instantiated.
class EmptyTally {
 public:
  void begin_tick() noexcept {}
  void lap(Stage, const Meter&) noexcept {}
  void lap(Stage, std::uint64_t) noexcept {}
  template <class Change>
  void count(const Change&) noexcept {}
  [[nodiscard]] const Counters* counters() const noexcept { return nullptr; }
  void reset() noexcept {}
};
static_assert(std::is_empty_v<EmptyTally>);

using Tally = std::conditional_t<PALPATE_COUNTERS != 0, CountingTally, EmptyTally>;

/// Raises a high-water mark.
inline void raise_mark(std::uint32_t& mark, std::size_t value) noexcept {
  if (value > mark) mark = static_cast<std::uint32_t>(value);
}

}  // namespace palpate
