// SPDX-License-Identifier: Apache-2.0
// The nodes of the front at which refinement stopped in this tick: near, and no detail that they
// miss can be felt. What follows need not look at the whole front again.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/assert.hpp"

namespace palpate::levels {

class Stopped {
 public:
  /// @param storage  [nodes of the tree]: a node stops once a tick
  explicit Stopped(std::span<std::uint32_t> storage) noexcept : storage_(storage) {}

  void add(std::uint32_t index) noexcept {
    PALPATE_ASSERT(count_ < storage_.size());
    storage_[count_++] = index;
  }

  /// In the order in which they stopped.
  [[nodiscard]] std::span<const std::uint32_t> all() const noexcept {
    return storage_.first(count_);
  }

 private:
  std::span<std::uint32_t> storage_;
  std::size_t count_ = 0;
};

}  // namespace palpate::levels
