// SPDX-License-Identifier: Apache-2.0
// What one kind of device adds to a transport: how it is brought up, what its bytes mean, what it
// is sent and when. Knows no thread and no clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/device.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal {

/// Bytes that a driver may send at once.
inline constexpr std::size_t kMaxOutBytes = 64;
using OutBuffer = std::array<std::byte, kMaxOutBytes>;

class Driver {
 public:
  virtual ~Driver() = default;
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  Driver(Driver&&) = delete;
  Driver& operator=(Driver&&) = delete;

  /// Identifies and readies the device; no force. Blocks. The problem where it cannot.
  [[nodiscard]] virtual std::optional<DeviceProblem> bring_up(Transport& transport) = 0;

  /// After bring_up().
  [[nodiscard]] virtual Capabilities capabilities() const noexcept = 0;

  /// Directly before streaming begins. Blocks. The problem where it cannot.
  [[nodiscard]] virtual std::optional<DeviceProblem> begin(Transport& transport) = 0;

  /// Bytes of one IN transfer. True, and `out` written, where they complete a newer reading: one
  /// that can be relied on, or one that says that the device is homing.
  [[nodiscard]] virtual bool received(std::span<const std::byte> bytes, std::uint64_t now_ns,
                                      DeviceState& out) noexcept = 0;

  /// What is to be sent now; how many bytes, 0 for nothing yet. Asked after every arrival and at
  /// least every kPollPeriod_ns. Where the command has expired: that there is to be no force.
  /// @param fresh  the command is newer than at the call before
  [[nodiscard]] virtual std::size_t poll(const DeviceCommand& command, bool fresh,
                                         std::uint64_t now_ns, OutBuffer& out) noexcept = 0;

  /// Bytes that end any force, for when the exchange ends.
  [[nodiscard]] virtual std::size_t farewell(OutBuffer& out) noexcept = 0;

  /// After streaming has ended. Best effort.
  virtual void end(Transport& transport) noexcept = 0;

  /// DeviceFault bits that do not come with a reading: an exchange that has broken down.
  [[nodiscard]] virtual std::uint32_t faults(std::uint64_t now_ns) const noexcept = 0;

  /// How long the first reading may take, and why there is none.
  [[nodiscard]] virtual double first_reading_within_s() const noexcept = 0;
  [[nodiscard]] virtual DeviceProblem why_no_reading() const = 0;
};

}  // namespace palpate::hal
