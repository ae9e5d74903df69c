// SPDX-License-Identifier: Apache-2.0
// A bounded queue from one thread to another without waiting: every value in order, or counted as
// dropped.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "hal/exchange.hpp"

namespace palpate::hal {

template <class T>
class Ring {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Room for at least `capacity` values (rounded up to a power of two). Allocates, and touches
  /// every byte.
  explicit Ring(std::size_t capacity)
      : slots_(std::bit_ceil(std::max<std::size_t>(capacity, 1))), mask_(slots_.size() - 1) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

  /// Appends a value. False where the ring is full: the value is dropped and counted. One writing
  /// thread only; wait-free.
  bool push(const T& value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == slots_.size()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    slots_[head & mask_] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Takes up to out.size() values, oldest first; how many. One reading thread only; wait-free.
  [[nodiscard]] std::size_t pop(std::span<T> out) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t count = std::min(head_.load(std::memory_order_acquire) - tail, out.size());
    for (std::size_t i = 0; i < count; ++i) out[i] = slots_[(tail + i) & mask_];
    tail_.store(tail + count, std::memory_order_release);
    return count;
  }

  /// Values that found the ring full. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  std::vector<T> slots_;
  std::size_t mask_;
  alignas(kCacheLineBytes) std::atomic<std::size_t> head_{0};
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLineBytes) std::atomic<std::size_t> tail_{0};
};

}  // namespace palpate::hal
