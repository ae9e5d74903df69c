// SPDX-License-Identifier: Apache-2.0
// A simulated device behind the device interface, with a stand-in for the real-time loop, in
// virtual time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "hal/protocol/host_driver.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/simulator/port.hpp"
#include "hal/transport/streamed_device.hpp"
#include "time.hpp"
#include "virtual_clock.hpp"

namespace palpate::hal::test {

inline constexpr std::uint64_t kTick_ns = kMs;
inline constexpr std::uint64_t kCommandLife_ns = 10 * kMs;

struct SimulatedRig {
  explicit SimulatedRig(simulator::SimulatedDevice& device_model, Clock& a_clock,
                        std::unique_ptr<Driver> driver, simulator::PortFaults faults = {},
                        bool threaded = false)
      : clock(a_clock) {
    auto transport = std::make_unique<simulator::Port>(device_model, clock, std::move(faults));
    port = transport.get();
    StreamOptions options;
    options.threaded = threaded;
    device =
        std::make_unique<StreamedDevice>(std::move(transport), std::move(driver), clock, options);
  }

  [[nodiscard]] std::optional<DeviceProblem> begin() const {
    if (auto problem = device->open()) return problem;
    return device->start();
  }

  /// For a while, the I/O thread's steps with a tick every millisecond in between; ends early where
  /// the device is lost.
  void run(std::uint64_t for_ns, const std::function<void()>& tick) {
    const std::uint64_t end_ns = clock.now_ns() + for_ns;
    std::uint64_t next_ns = clock.now_ns();
    while (clock.now_ns() < end_ns) {
      if (clock.now_ns() >= next_ns) {
        tick();
        next_ns += kTick_ns;
      }
      if (!device->step()) return;
    }
  }

  /// Answers the newest reading with a force along x.
  void push(double force_N) {
    static_cast<void>(device->receive(reading));
    ++command.sequence;
    command.time_ns = clock.now_ns();
    command.expires_ns = clock.now_ns() + kCommandLife_ns;
    command.wrench.force_N = {force_N, 0, 0};
    command.answers = reading.sequence;
    command.state_time_ns = reading.time_ns;
    device->send(command);
  }

  Clock& clock;
  simulator::Port* port = nullptr;
  std::unique_ptr<StreamedDevice> device;
  DeviceState reading;
  DeviceCommand command;
};

}  // namespace palpate::hal::test
