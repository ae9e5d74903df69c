// SPDX-License-Identifier: Apache-2.0
// A model of a six-axis device that speaks the open protocol: a hand on a handle, encoders, and the
// device's half of the protocol as firmware would run it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/flash/dfu_device.hpp"
#include "hal/mock/faults.hpp"
#include "hal/mock/hand.hpp"
#include "hal/protocol/device_end.hpp"
#include "hal/simulator/simulated_device.hpp"

namespace palpate::hal::simulator {

struct OpenDeviceOptions {
  mock::HandParameters hand;
  protocol::Capabilities capabilities = default_capabilities();
  /// Its flash, which outlives it; null: it holds no images.
  flash::FlashMemory* flash = nullptr;
  flash::SlotLayout layout;
  flash::FlashTimes flash_times;  ///< what its flash takes, in its own time
  /// The public key that images must be signed for; absent: none
  std::optional<signature::PublicKey> key;
  std::string serial = "SIM0001";
  /// How long a restart keeps it off the bus; 0: it stays, which the protocol does not allow.
  std::uint64_t restart_ns = 100'000'000;
  /// stuck and drift, from its first period on
  mock::Faults sensor_faults;

  [[nodiscard]] static protocol::Capabilities default_capabilities() noexcept;
};

class OpenDevice : public SimulatedDevice {
 public:
  explicit OpenDevice(OpenDeviceOptions options);

  [[nodiscard]] const UsbDescriptors& descriptors() const override { return descriptors_; }
  void advance_to(std::uint64_t now_ns) override;
  [[nodiscard]] std::uint64_t next_event_ns() const override { return next_ns_; }
  [[nodiscard]] Presence presence() const override { return {back_ns_ == 0, times_left_}; }
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out) override;
  IoResult control_out(const ControlRequest& request, std::span<const std::byte> data) override;
  void out(std::span<const std::byte> bytes) override;
  std::size_t in(std::span<std::byte> buffer) override;
  void bus_reset() override;

  // What a test does to it, and sees.

  /// As after power came: its newest image, its self-test.
  void restart();
  void set_health(std::uint16_t health) noexcept { end_.set_health(health); }
  void set_homing(bool homing) noexcept { end_.set_homing(homing); }
  /// It takes readings but sends none.
  void set_silent(bool silent) noexcept { silent_ = silent; }
  [[nodiscard]] protocol::Mode mode() const noexcept { return end_.mode(); }
  /// What it renders in the period that runs.
  [[nodiscard]] const Wrench& rendered() const noexcept { return rendered_; }
  [[nodiscard]] const Pose& pose() const noexcept { return hand_.pose(); }
  /// Its periods so far, and those with a force.
  [[nodiscard]] std::uint64_t periods() const noexcept { return periods_; }
  [[nodiscard]] std::uint64_t periods_with_force() const noexcept { return periods_with_force_; }
  /// How long ago the last command with a force came.
  [[nodiscard]] std::uint64_t since_force_ns() const noexcept { return now_ns_ - forced_ns_; }

 private:
  void period(std::uint64_t now_ns);
  void work_on_flash();
  void leave_bus();
  [[nodiscard]] flash::SlotRules rules() const noexcept;
  [[nodiscard]] protocol::ImageIdentity identity() const;
  IoResult vendor_in(const ControlRequest& request, std::span<std::byte> out);
  IoResult vendor_out(const ControlRequest& request);
  IoResult update(const ControlRequest& request, std::span<const std::byte> data,
                  std::span<std::byte> out);

  OpenDeviceOptions options_;
  UsbDescriptors descriptors_;
  mock::Hand hand_;
  protocol::DeviceEnd end_;
  std::uint64_t period_ns_;
  std::uint64_t start_ns_ = 0;
  std::uint64_t next_ns_ = 0;  ///< 0: not begun
  std::uint64_t now_ns_ = 0;
  std::uint64_t forced_ns_ = 0;
  std::uint64_t back_ns_ = 0;  ///< when a restart is over; 0: none is under way
  std::uint32_t times_left_ = 0;
  std::uint64_t periods_ = 0;
  std::uint64_t periods_with_force_ = 0;
  bool silent_ = false;
  Pose seen_;  ///< by its encoders
  Wrench rendered_;
  std::optional<protocol::Packet> ready_;
  bool in_session_ = false;
  std::optional<flash::Slots> slots_;
  std::optional<flash::DfuDevice> dfu_;
  std::uint64_t flash_ns_ = 0;  ///< when the step of its flash that is under way is over
};

}  // namespace palpate::hal::simulator
