// SPDX-License-Identifier: Apache-2.0
// The device's side of USB DFU 1.1 over two slots, for firmware. Freestanding.
//
// Firmware hands every class request of the DFU interface to handle(), with interrupts of the motor
// loop still running: erasing and writing happen inside. While busy() there must be no force.
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

class DfuDevice {
 public:
  static constexpr std::uint16_t kTransferBytes = 1024;  ///< wTransferSize

  explicit DfuDevice(Slots& slots) noexcept : slots_(slots) {}

  /// One request. @param data  of a download; room asked for by an upload counts as its length
  /// (`wanted`)
  DfuAnswer handle(const DfuSetup& setup, std::span<const std::byte> data,
                   std::size_t wanted) noexcept;

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
  DfuAnswer settle(UpdateStatus status, DfuState next) noexcept;
  void give_up() noexcept;

  Slots& slots_;
  std::uint8_t slot_ = 0;
  DfuState state_ = DfuState::idle;
  DfuStatus status_ = DfuStatus::ok;
  std::uint16_t next_block_ = 0;
  std::size_t uploaded_ = 0;
  std::span<const std::byte> image_;  ///< that is read back
  std::array<std::byte, kStatusReplyBytes> reply_{};
};

}  // namespace palpate::hal::flash
