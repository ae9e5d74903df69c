// SPDX-License-Identifier: Apache-2.0
// A model of the Falcon: serial bridge, boot loader, firmware and a hand on its grip, made from the
// published facts of the protocol. It holds no firmware of anyone: whatever bytes are uploaded, the
// model's own code runs.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "hal/falcon/ftdi.hpp"
#include "hal/falcon/messages.hpp"
#include "hal/mock/hand.hpp"
#include "hal/simulator/simulated_device.hpp"

namespace palpate::hal::simulator {

struct FalconDeviceOptions {
  mock::HandParameters hand;
  bool firmware_runs = false;      ///< at the start
  double homed_after_s = 0.5;      ///< of requests with the homing flag
  int deaf_to_hellos = 0;          ///< hellos that go unanswered
  bool zero_before_hello = false;  ///< a zero byte comes before the first answer
  int bad_uploads = 0;             ///< uploads with one byte of the echo changed
  bool runs_what_it_got = true;    ///< false: the uploaded bytes do not answer
  bool ignores_latency = false;    ///< the bridge keeps 16 ms whatever it is told
  std::string serial = "SIM0001";
};

class FalconDevice final : public SimulatedDevice {
 public:
  explicit FalconDevice(FalconDeviceOptions options);

  [[nodiscard]] const UsbDescriptors& descriptors() const override { return descriptors_; }
  void advance_to(std::uint64_t now_ns) override;
  [[nodiscard]] std::uint64_t next_event_ns() const override;
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out) override;
  IoResult control_out(const ControlRequest& request, std::span<const std::byte> data) override;
  void out(std::span<const std::byte> bytes) override;
  std::size_t in(std::span<std::byte> buffer) override;
  void bus_reset() override {}

  // What a test does to it, and sees.

  /// Replies from now on lack this many bytes.
  void shorten_replies(std::size_t by) noexcept { shorten_by_ = by; }
  /// The firmware answers nothing any more, or does again.
  void set_mute(bool mute) noexcept { mute_ = mute; }
  void forget_zero() noexcept { homing_s_ = 0; }
  [[nodiscard]] const falcon::MotorValues& motors() const noexcept { return motors_; }
  [[nodiscard]] const std::vector<std::byte>& uploaded() const noexcept { return uploaded_; }
  [[nodiscard]] Vec3d position_m() const noexcept { return hand_.pose().position_m; }

 private:
  enum class Processor { off, loader, greeted, uploading, firmware };
  void set_modem(std::uint16_t value);
  void set_baud(std::uint16_t value);
  void loader(std::span<const std::byte> bytes);
  void firmware(std::span<const std::byte> bytes);
  void answer(const falcon::Request& request);
  void say(std::span<const std::byte> bytes);
  [[nodiscard]] bool is_homed() const noexcept;

  FalconDeviceOptions options_;
  UsbDescriptors descriptors_;
  mock::Hand hand_;
  Processor processor_;
  falcon::Baud baud_ = falcon::Baud::b9600;
  bool dtr_ = true;
  std::uint8_t latency_ms_ = 16;
  std::uint64_t now_ns_ = 0;
  std::uint64_t next_step_ns_ = 0;  ///< of the hand; 0: not begun
  std::uint64_t next_tick_ns_ = 0;  ///< of the latency timer
  bool tick_due_ = false;
  std::deque<std::byte> said_;  ///< by the processor, not yet fetched
  std::vector<std::byte> uploaded_;
  std::vector<std::byte> heard_;  ///< by the firmware, no whole request yet
  falcon::MotorValues motors_{};
  double homing_s_ = 0;
  bool homing_ = false;
  bool mute_ = false;
  std::size_t shorten_by_ = 0;
};

}  // namespace palpate::hal::simulator
