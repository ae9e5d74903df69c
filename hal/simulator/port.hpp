// SPDX-License-Identifier: Apache-2.0
// A simulated device as a transport, on any clock, with faults by script: everything of the device
// layer but the kernel runs as it does on hardware.
#pragma once

#include <array>
#include <cstdint>

#include "hal/clock.hpp"
#include "hal/mock/faults.hpp"
#include "hal/simulator/simulated_device.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal::simulator {

/// Faults of each direction: drop, delay, repeat, reorder, truncate, corrupt; unplug in either.
/// Times count from the port's creation. Control transfers know unplug only.
struct PortFaults {
  mock::Faults in;
  mock::Faults out;
};

class Port final : public Transport {
 public:
  static constexpr std::size_t kMaxTransferBytes = 512;
  static constexpr std::size_t kOutTransfers = 4;

  /// Device and clock must outlive this. Lost for good where the device is off the bus, or leaves
  /// it later.
  Port(SimulatedDevice& device, Clock& clock, PortFaults faults = {});

  [[nodiscard]] std::uint8_t interface_number() const noexcept override { return interface_; }
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out,
                      std::uint32_t timeout_ms) override;
  IoResult control_out(const ControlRequest& request, std::span<const std::byte> data,
                       std::uint32_t timeout_ms) override;
  IoStatus select_alternate(std::uint8_t setting) override;
  IoResult read(std::span<std::byte> out, std::uint32_t timeout_ms) override;
  IoResult write(std::span<const std::byte> data, std::uint32_t timeout_ms) override;
  IoStatus begin_stream() override;
  bool submit(std::span<const std::byte> data) override;
  [[nodiscard]] std::size_t pending() const noexcept override { return pending_; }
  IoStatus wait(std::uint64_t until_ns, StreamSink& sink) override;
  void end_stream() noexcept override;

  /// Another interface of the device from now on; 0 at first.
  void claim(std::uint8_t interface) noexcept { interface_ = interface; }

  /// OUT transfers neither arrive nor complete any more, or do again.
  void hold_out(bool hold) noexcept { hold_out_ = hold; }

 private:
  struct Transfer {
    std::array<std::byte, kMaxTransferBytes> bytes;
    std::size_t length = 0;
  };
  void live_to(std::uint64_t now_ns);
  [[nodiscard]] bool is_plugged(double t_s);
  [[nodiscard]] double seconds(std::uint64_t now_ns) const noexcept;
  static void spoil(Transfer& transfer, double t_s, mock::Faults& faults);

  SimulatedDevice& device_;
  Clock& clock_;
  PortFaults faults_;
  std::uint64_t start_ns_;
  std::uint32_t times_left_;  ///< by the device when this was plugged in
  std::uint8_t interface_ = 0;
  bool lost_;
  bool hold_out_ = false;
  std::size_t pending_ = 0;
  mock::FaultyLine<Transfer> in_line_;
  mock::FaultyLine<Transfer> out_line_;
};

}  // namespace palpate::hal::simulator
