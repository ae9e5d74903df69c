// SPDX-License-Identifier: Apache-2.0
// Time that passes by being read.
#pragma once

#include <cstdint>

namespace palpate::test {

/// For Budget::clock_ns and clock_context: a nanosecond a reading.
struct CountingClock {
  std::uint64_t now = 0;
  static std::uint64_t read(void* self) { return ++static_cast<CountingClock*>(self)->now; }
};

}  // namespace palpate::test
