// SPDX-License-Identifier: Apache-2.0
// The device's side of USB DFU 1.1 over two slots, for firmware. Freestanding.
//
// Firmware hands every class request of the DFU interface to handle(), which never writes to the
// flash, and calls work() from its main loop for as long as it returns true: one erasure, or one
// block, at a time. Meanwhile the host is told how long that takes, and waits. All on one thread,
// with interrupts of the motor loop running. While busy() there must be no force.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/flash/dfu.hpp"
#include "hal/flash/slots.hpp"

namespace palpate::hal::flash {

/// The fields of a set-up packet that count.
struct DfuSetup {
  DfuRequest request = DfuRequest::get_status;
  std::uint16_t block = 0;  ///< wValue
};

/// What to answer. `bytes` are valid until the next call.
struct DfuAnswer {
  bool stall = false;
  std::span<const std::byte> bytes;
};

/// The longest times of a device's flash and processor: what the host is told to wait for.
struct FlashTimes {
  std::uint32_t erase_ms = 0;  ///< of one erase unit
  std::uint32_t write_ms = 0;  ///< of a block of DfuDevice::kTransferBytes
  std::uint32_t check_ms = 0;  ///< of the largest image: its hash, structure and signature
};

class DfuDevice {
 public:
  static constexpr std::uint16_t kTransferBytes = 1024;  ///< wTransferSize

  explicit DfuDevice(Slots& slots, const FlashTimes& times = {}) noexcept
      : slots_(slots), times_(times) {}

  /// One request. @param data  of a download; room asked for by an upload counts as its length
  /// (`wanted`)
  DfuAnswer handle(const DfuSetup& setup, std::span<const std::byte> data,
                   std::size_t wanted) noexcept;

  /// One step of what the host has asked for. True where there is more to do.
  bool work() noexcept;
  /// How long that step takes at most.
  [[nodiscard]] std::uint32_t step_ms() const noexcept;
  /// work() has something to do.
  [[nodiscard]] bool has_work() const noexcept { return has_work_; }

  /// The host has chosen an alternate setting: the slot that requests are about.
  void select(std::uint8_t slot) noexcept;

  /// The bus was reset: an update under way is given up.
  void bus_reset() noexcept;

  /// An update or a read-back is under way.
  [[nodiscard]] bool busy() const noexcept { return state_ != DfuState::idle; }
  [[nodiscard]] DfuState state() const noexcept { return state_; }

 private:
  DfuAnswer download(std::uint16_t block, std::span<const std::byte> data) noexcept;
  DfuAnswer upload(std::uint16_t block, std::size_t wanted) noexcept;
  DfuAnswer get_status() noexcept;
  DfuAnswer fail(DfuStatus status) noexcept;
  [[nodiscard]] std::uint32_t erasures() const noexcept;
  [[nodiscard]] std::uint32_t poll_ms() const noexcept;
  void give_up() noexcept;

  Slots& slots_;
  FlashTimes times_;
  std::uint8_t slot_ = 0;
  DfuState state_ = DfuState::idle;
  DfuStatus status_ = DfuStatus::ok;
  std::uint16_t next_block_ = 0;
  bool has_work_ = false;
  std::size_t block_bytes_ = 0;  ///< to be written; 0: the whole is to be proved and committed
  std::array<std::byte, kTransferBytes> block_{};
  std::size_t uploaded_ = 0;
  std::span<const std::byte> image_;  ///< that is read back
  std::array<std::byte, kStatusReplyBytes> reply_{};
};

}  // namespace palpate::hal::flash
