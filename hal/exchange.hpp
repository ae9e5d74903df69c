// SPDX-License-Identifier: Apache-2.0
// The newest value of something, handed from one thread to another without waiting: a triple
// buffer.
//
// One slot belongs to the writer, one to the reader, one lies between; publishing and taking each
// swap their own slot with the one between in a single atomic exchange. So neither side ever waits,
// retries or sees a value half written, and the reader gets the newest complete value; older unread
// ones are overwritten.
//
// Source: the technique is folklore; Simpson, "Four-slot fully asynchronous communication
// mechanism", IEE Proc. E 137(1), 1990, is its ancestor. Departure: three slots suffice because the
// swap is atomic.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace palpate::hal {

/// Bytes that two threads' data are kept apart by, so that they do not fight over a cache line.
inline constexpr std::size_t kCacheLineBytes = 64;

template <class T>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Publishes a value. One writing thread only. Wait-free: a copy and one atomic exchange.
  void write(const T& value) noexcept {
    slots_[writer_slot_].value = value;
    writer_slot_ = between_.exchange(writer_slot_ | kFresh, std::memory_order_acq_rel) & kSlotMask;
  }

  /// Takes the newest value. One reading thread only. False, and `out` untouched, where nothing was
  /// written since the last read. Wait-free: at most one atomic exchange and a copy.
  [[nodiscard]] bool read(T& out) noexcept {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reader_slot_ = between_.exchange(reader_slot_, std::memory_order_acq_rel) & kSlotMask;
    out = slots_[reader_slot_].value;
    return true;
  }

 private:
  static constexpr std::uint32_t kFresh = 4;  ///< set where the slot between holds an unread value
  static constexpr std::uint32_t kSlotMask = 3;

  struct alignas(kCacheLineBytes) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(kCacheLineBytes) std::atomic<std::uint32_t> between_{1};
  alignas(kCacheLineBytes) std::uint32_t writer_slot_ = 0;
  alignas(kCacheLineBytes) std::uint32_t reader_slot_ = 2;
};

}  // namespace palpate::hal
