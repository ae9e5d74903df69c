// SPDX-License-Identifier: GPL-3.0-or-later
// The loops' clock as an engine's budget reads it.
#pragma once

#include <cmath>
#include <cstdint>

#include "hal/clock.hpp"

namespace palpate::realtime {

/// For Budget::clock_ns; `context` is a hal::Clock.
inline std::uint64_t clock_of(void* context) { return static_cast<hal::Clock*>(context)->now_ns(); }

/// Of seconds from 0 to 1.8e10, rounded.
inline std::uint64_t nanoseconds(double s) {
  return static_cast<std::uint64_t>(std::llround(1e9 * s));
}

}  // namespace palpate::realtime
