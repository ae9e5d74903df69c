// SPDX-License-Identifier: Apache-2.0
// Hands out arrays from one block of memory. Run over no memory it only counts, so that size and
// layout come from one function.
#pragma once

#include <cstddef>
#include <new>
#include <span>

namespace palpate {

class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;

  Arena() = default;  ///< counts only
  explicit Arena(std::span<std::byte> memory) noexcept : memory_(memory) {}

  /// An array of `count` T, every element default-initialised, on a 64-byte boundary; empty when
  /// only counting or when the memory is used up.
  template <class T>
  std::span<T> array(std::size_t count) noexcept {
    const std::size_t start = used_;
    used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    if (used_ > memory_.size()) return {};
    static_assert(alignof(T) <= kAlignment);
    T* first = static_cast<T*>(static_cast<void*>(memory_.data() + start));
    for (std::size_t i = 0; i < count; ++i) ::new (static_cast<void*>(first + i)) T{};
    return {first, count};
  }

  [[nodiscard]] std::size_t used() const noexcept { return used_; }

 private:
  std::span<std::byte> memory_;
  std::size_t used_ = 0;
};

}  // namespace palpate
