// SPDX-License-Identifier: Apache-2.0
// The mock device: a simulated hand behind the device interface, in real time on a thread of its
// own or in virtual time.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "hal/clock.hpp"
#include "hal/device.hpp"
#include "hal/exchange.hpp"
#include "hal/mock/faults.hpp"
#include "hal/mock/follower.hpp"
#include "hal/mock/hand.hpp"

namespace palpate::hal::mock {

enum class TimeBase {
  real,     ///< start() begins a thread that keeps the rate
  virtual_  ///< nothing moves but by advance_to(); deterministic
};

struct Options {
  double rate_Hz = 2000.0;  ///< of readings; > 0
  TimeBase time_base = TimeBase::real;
  int fifo_priority = 0;        ///< of the thread, 1 to 98; 0 or not permitted: an ordinary thread
  double homing_s = 0;          ///< so long it looks for its zero, from the hand's time zero
  std::uint8_t sensed_dof = 6;  ///< 3: its readings say nothing of the orientation
  std::uint8_t rendered_dof = 6;  ///< 3: it renders no torque
  double max_force_N = 20.0;      ///< what it renders at most
  double max_torque_Nm = 1.0;     ///< what it renders at most; 0 with rendered_dof 3
  /// What goes wrong, from the hand's time zero. A reading has no bytes here: one that is truncated
  /// or corrupted is one that a packet check has refused. While unplugged nothing is rendered.
  std::vector<FaultWindow> faults;
  std::uint64_t fault_seed = 1;
  /// The hand goes where lead() says, in its script's stead.
  std::optional<FollowLimits> led;
};

class MockDevice final : public Device {
 public:
  MockDevice(HandParameters hand, const Options& options);
  ~MockDevice() override;

  [[nodiscard]] Capabilities capabilities() const noexcept override;
  [[nodiscard]] std::optional<DeviceProblem> open() override;
  [[nodiscard]] std::optional<DeviceProblem> start() override;
  [[nodiscard]] bool receive(DeviceState& out) noexcept override { return states_.read(out); }
  void send(const DeviceCommand& command) noexcept override { commands_.write(command); }
  void stop() noexcept override;
  [[nodiscard]] std::uint32_t faults() const noexcept override {
    return faults_.load(std::memory_order_relaxed);
  }

  /// With Options::led. Wait-free, any one thread.
  void lead(const Lead& lead) noexcept { leads_.write(lead); }

  /// Virtual time only: lives through every device period up to and including a time. The first
  /// call sets time zero of the hand and publishes the first reading.
  void advance_to(std::uint64_t time_ns) noexcept;

  /// Where the hand is, sensed or not. Virtual time only, after open().
  [[nodiscard]] const Pose& hand_pose() const noexcept { return hand_->pose(); }

 private:
  void run() noexcept;
  void begin_at(std::uint64_t time_ns) noexcept;
  void period(std::uint64_t time_ns) noexcept;
  void advance_hand(const Wrench& wrench) noexcept;
  void publish(std::uint64_t time_ns) noexcept;
  void publish_faulty(DeviceState state) noexcept;
  [[nodiscard]] double seconds(std::uint64_t time_ns) const noexcept;
  [[nodiscard]] bool is_homing(std::uint64_t time_ns) const noexcept;
  [[nodiscard]] Wrench wrench_in_force(std::uint64_t time_ns) noexcept;

  Options options_;
  HandParameters parameters_;
  std::uint64_t period_ns_ = 0;
  std::optional<Hand> hand_;
  std::optional<Follower> follower_;  ///< where the hand is led
  std::uint64_t next_ns_ = 0;         ///< when the next period begins; 0 before the first
  std::uint64_t zero_ns_ = 0;         ///< time zero of the hand
  std::uint64_t sequence_ = 0;
  Faults script_;
  FaultyLine<DeviceState> line_;
  bool unplugged_ = false;
  Pose stuck_at_;
  DeviceCommand command_;  ///< the last one taken
  Mailbox<DeviceState> states_;
  Mailbox<DeviceCommand> commands_;
  Mailbox<Lead> leads_;
  std::atomic<std::uint32_t> faults_{kNoDeviceFault};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace palpate::hal::mock
