// SPDX-License-Identifier: GPL-3.0-or-later
// What a loop's clock and period leave for a contact query.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "hal/clock.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::realtime {

/// For Budget::clock_ns; `context` is a hal::Clock.
inline std::uint64_t clock_of(void* context) { return static_cast<hal::Clock*>(context)->now_ns(); }

/// Of seconds from 0 to 1.8e10, rounded.
inline std::uint64_t nanoseconds(double s) {
  return static_cast<std::uint64_t>(std::llround(1e9 * s));
}

/// Of one query.
struct QueryTime {
  std::optional<double> budget_us;  ///< absent: until the query has to end
  /// Beyond that, while nothing is felt and no contact ruled out (Budget::reserve_ns); absent:
  /// until the query has to end.
  std::optional<double> reserve_us;
};

/// @param begin_ns, end_ns  when a query begins, and when it has to end whatever it was given
inline Budget budget_between(hal::Clock& clock, std::uint64_t begin_ns, std::uint64_t end_ns,
                             const QueryTime& time) {
  const auto until = [end_ns](std::uint64_t from_ns, const std::optional<double>& us) {
    return us ? std::min(end_ns, from_ns + nanoseconds(1e-6 * *us)) : end_ns;
  };
  Budget budget;
  budget.clock_ns = clock_of;
  budget.clock_context = &clock;
  budget.deadline_ns = until(begin_ns, time.budget_us);
  budget.reserve_ns = until(budget.deadline_ns, time.reserve_us) - budget.deadline_ns;
  return budget;
}

}  // namespace palpate::realtime
