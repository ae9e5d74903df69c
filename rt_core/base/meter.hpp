// SPDX-License-Identifier: Apache-2.0
// Counts the work of a tick against its budget.
#pragma once

#include <cstdint>

#include "rt_core/palpate_rt.hpp"

namespace palpate {

/// The clock is read before every query: it is handed in and cheap (a cycle counter, a vDSO call).
class Meter {
 public:
  explicit Meter(const Budget& budget) noexcept : budget_(budget) {}

  void charge(std::uint64_t units) noexcept { used_ += units; }
  [[nodiscard]] std::uint64_t used() const noexcept { return used_; }
  [[nodiscard]] bool out_of_units() const noexcept { return used_ >= budget_.units; }
  [[nodiscard]] bool out_of_time() const noexcept {
    return budget_.clock_ns != nullptr &&
           budget_.clock_ns(budget_.clock_context) >= budget_.deadline_ns;
  }

 private:
  Budget budget_;
  std::uint64_t used_ = 0;
};

}  // namespace palpate
