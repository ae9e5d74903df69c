// SPDX-License-Identifier: Apache-2.0
// A binary min-heap over borrowed memory.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/assert.hpp"

namespace palpate {

/// Smallest first by `less(a, b)`, which must be a strict total order for results that do not
/// depend on history.
template <class T, class Less>
class MinQueue {
 public:
  explicit MinQueue(std::span<T> storage, Less less = {}) noexcept
      : storage_(storage), less_(less) {}

  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::span<const T> items() const noexcept {
    return storage_.first(size_);
  }  ///< in heap order
  [[nodiscard]] const T& top() const noexcept { return storage_[0]; }

  void clear() noexcept { size_ = 0; }

  /// Takes over all of the storage as it lies. O(n)
  void fill() noexcept {
    size_ = storage_.size();
    for (std::size_t i = size_ / 2; i-- > 0;) sink(i, storage_[i]);
  }

  /// The same of storage that lies in heap order. O(1)
  void adopt() noexcept { size_ = storage_.size(); }

  void push(const T& item) noexcept {  ///< O(log n)
    PALPATE_ASSERT(size_ < storage_.size());
    std::size_t hole = size_++;
    while (hole > 0) {
      const std::size_t parent = (hole - 1) / 2;
      if (!less_(item, storage_[parent])) break;
      storage_[hole] = storage_[parent];
      hole = parent;
    }
    storage_[hole] = item;
  }

  void pop() noexcept {  ///< O(log n)
    PALPATE_ASSERT(size_ > 0);
    const T item = storage_[--size_];
    sink(0, item);
  }

 private:
  /// Which of two children is taken is not a branch: it would be guessed wrong every other time.
  void sink(std::size_t hole, const T item) noexcept {
    std::size_t child = 2 * hole + 1;
    for (; child + 1 < size_; child = 2 * hole + 1) {
      child += less_(storage_[child + 1], storage_[child]) ? 1u : 0u;
      if (!less_(storage_[child], item)) break;
      storage_[hole] = storage_[child];
      hole = child;
    }
    if (child + 1 == size_ && less_(storage_[child], item)) {
      storage_[hole] = storage_[child];
      hole = child;
    }
    storage_[hole] = item;
  }

  std::span<T> storage_;
  std::size_t size_ = 0;
  Less less_;
};

}  // namespace palpate
