// SPDX-License-Identifier: Apache-2.0
// A device on a transport, behind the device interface: the I/O thread between the bus and the
// real-time thread.
//
// The I/O thread owns the transport while it runs. It hands readings to the real-time thread and
// takes commands from it through mailboxes; so the real-time side never waits, and never enters
// libusb. A command whose maker has fallen silent expires here, and the device is told to render
// nothing; the device's own watchdog does the same when this thread falls silent too. The force
// does not come back before the next start(): whoever fell silent would find another pose than he
// left.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>

#include "hal/clock.hpp"
#include "hal/device.hpp"
#include "hal/exchange.hpp"
#include "hal/transport/driver.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal {

/// A new command waits at most this long for the I/O thread to see it: the real-time thread cannot
/// wake it up without a system call.
inline constexpr std::uint64_t kPollPeriod_ns = 250'000;

struct StreamOptions {
  int fifo_priority = 0;  ///< of the I/O thread, 1 to 98; 0 or not permitted: an ordinary thread
  bool threaded = true;   ///< false: nothing moves but by step(), for tests in virtual time
};

class StreamedDevice final : public Device, private StreamSink {
 public:
  /// The clock must outlive this.
  StreamedDevice(std::unique_ptr<Transport> transport, std::unique_ptr<Driver> driver, Clock& clock,
                 const StreamOptions& options);
  ~StreamedDevice() override;

  [[nodiscard]] Capabilities capabilities() const noexcept override;
  [[nodiscard]] std::optional<DeviceProblem> open() override;
  /// Waits for the first reading.
  [[nodiscard]] std::optional<DeviceProblem> start() override;
  [[nodiscard]] bool receive(DeviceState& out) noexcept override { return states_.read(out); }
  void send(const DeviceCommand& command) noexcept override { commands_.write(command); }
  void stop() noexcept override;
  [[nodiscard]] std::uint32_t faults() const noexcept override {
    return faults_.load(std::memory_order_relaxed);
  }

  /// What the I/O thread does again and again: waits for the bus, at most kPollPeriod_ns, and sends
  /// what is due. False where the device is lost. Not with a thread.
  bool step() noexcept;

  /// OUT packets that found the whole pool under way. Any thread.
  [[nodiscard]] std::uint64_t crowded_out() const noexcept {
    return crowded_out_.load(std::memory_order_relaxed);
  }

 private:
  void received(std::span<const std::byte> bytes, std::uint64_t now_ns) noexcept override;
  [[nodiscard]] bool wait_for_first_reading() noexcept;
  void forget_last_run() noexcept;
  void run() noexcept;
  void take_command(std::uint64_t now_ns) noexcept;
  void send_due() noexcept;
  void publish_fault(std::uint32_t faults) noexcept;
  void say_farewell() noexcept;

  std::unique_ptr<Transport> transport_;
  std::unique_ptr<Driver> driver_;
  Clock& clock_;
  StreamOptions options_;
  bool open_ = false;
  bool streaming_ = false;
  DeviceState state_;         ///< the newest; of the I/O thread
  std::uint32_t broken_ = 0;  ///< faults that no reading takes back
  DeviceCommand command_;     ///< in force, or expired; of the I/O thread
  bool fresh_ = false;        ///< it has been taken just now
  bool commanded_ = false;    ///< there has been one since start()
  Mailbox<DeviceState> states_;
  Mailbox<DeviceCommand> commands_;
  std::atomic<std::uint32_t> faults_{kNoDeviceFault};
  std::atomic<std::uint64_t> readings_{0};
  std::atomic<std::uint64_t> crowded_out_{0};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace palpate::hal
