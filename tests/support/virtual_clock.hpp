// SPDX-License-Identifier: Apache-2.0
// Time that passes only by sleeping.
#pragma once

#include <cstdint>

#include "hal/clock.hpp"

namespace palpate::hal::test {

class VirtualClock final : public Clock {
 public:
  std::uint64_t now_ns() noexcept override { return now_ns_; }
  void sleep_until(std::uint64_t time_ns) noexcept override {
    if (time_ns > now_ns_) now_ns_ = time_ns;
  }

 private:
  std::uint64_t now_ns_ = 1'000'000'000;
};

}  // namespace palpate::hal::test
