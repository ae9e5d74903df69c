// SPDX-License-Identifier: Apache-2.0
// A USB device as a model: what it does with requests and packets, in a time that is told to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/simulator/descriptors.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal::simulator {

/// Whether a device is there. It leaves by itself when it restarts: whoever had it open has lost it
/// then, and opens it again once it is back.
struct Presence {
  bool on_bus = true;
  std::uint32_t times_left = 0;  ///< how often it has left by itself
};

class SimulatedDevice {
 public:
  virtual ~SimulatedDevice() = default;
  SimulatedDevice() = default;
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;
  SimulatedDevice(SimulatedDevice&&) = delete;
  SimulatedDevice& operator=(SimulatedDevice&&) = delete;

  /// What it says about itself, for as long as it lives.
  [[nodiscard]] virtual const UsbDescriptors& descriptors() const = 0;

  /// Lives through the time up to and including now. Time never runs backwards.
  virtual void advance_to(std::uint64_t now_ns) = 0;
  /// When in() may have something next, if nothing else happens.
  [[nodiscard]] virtual std::uint64_t next_event_ns() const = 0;

  [[nodiscard]] virtual Presence presence() const { return {}; }

  virtual IoResult control_in(const ControlRequest& request, std::span<std::byte> out) = 0;
  virtual IoResult control_out(const ControlRequest& request, std::span<const std::byte> data) = 0;
  /// One OUT transfer.
  virtual void out(std::span<const std::byte> bytes) = 0;
  /// The IN transfer that is ready, taken away; its length, 0 for none.
  virtual std::size_t in(std::span<std::byte> buffer) = 0;
  /// The bus was reset, or the plug pulled out.
  virtual void bus_reset() = 0;
};

}  // namespace palpate::hal::simulator
