// SPDX-License-Identifier: Apache-2.0
// Hands out arrays from one block of memory. Run over no memory it only counts, and over memory in
// use it finds the arrays again, so that size and layout come from one function.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <type_traits>

namespace palpate {

class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;

  enum class Contents : bool { made, kept };

  Arena() = default;  ///< counts only
  explicit Arena(std::span<std::byte> memory, Contents contents = Contents::made) noexcept
      : memory_(memory), contents_(contents) {}

  /// An array of `count` T on a 64-byte boundary, every element default-initialised or, with
  /// Contents::kept, as it is in memory; empty when only counting or when the memory is used up.
  template <class T>
  std::span<T> array(std::size_t count) noexcept {
    const std::size_t start = used_;
    used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    if (used_ > memory_.size()) return {};
    static_assert(alignof(T) <= kAlignment);
    static_assert(std::is_trivially_copyable_v<T>);  // its bytes are all there is of it
    T* first = static_cast<T*>(static_cast<void*>(memory_.data() + start));
    if (contents_ == Contents::kept) return {std::launder(first), count};
    for (std::size_t i = 0; i < count; ++i) ::new (static_cast<void*>(first + i)) T{};
    return {first, count};
  }

  [[nodiscard]] std::size_t used() const noexcept { return used_; }

 private:
  std::span<std::byte> memory_;
  Contents contents_ = Contents::made;
  std::size_t used_ = 0;
};

}  // namespace palpate
