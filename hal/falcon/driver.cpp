// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/driver.hpp"

#include <algorithm>
#include <array>

#include "hal/falcon/bring_up.hpp"
#include "hal/falcon/ftdi.hpp"

namespace palpate::hal::falcon {
namespace {

/// The figures that CHAI3D lists for the device.
constexpr double kMaxForce_N = 8.0;
constexpr double kRate_Hz = 1000.0;
/// A reply takes about 1 ms; a request that has none after this long is repeated.
constexpr std::uint64_t kReplyWithin_ns = 20'000'000;
/// In a row: 0.2 s without an answer.
constexpr std::uint32_t kSilentRequestsToFault = 10;
constexpr std::uint32_t kBadCountsToFault = 5;
constexpr double kFirstReadingWithin_s = 2.0;
constexpr std::uint8_t kGreenLed = 0x2;
constexpr std::uint8_t kRedLed = 0x8;

std::size_t copy(const Message& message, OutBuffer& out) noexcept {
  std::copy(message.begin(), message.end(), out.begin());
  return message.size();
}

}  // namespace

std::optional<DeviceProblem> FalconDriver::bring_up(Transport& transport) {
  return falcon::bring_up(transport, firmware_);
}

Capabilities FalconDriver::capabilities() const noexcept {
  Capabilities c;
  c.max_force_N = kMaxForce_N;
  c.max_torque_Nm = 0;
  c.rate_Hz = kRate_Hz;
  c.sensed_dof = 3;
  c.rendered_dof = 3;
  return c;
}

std::optional<DeviceProblem> FalconDriver::begin(Transport& /*transport*/) {
  parser_ = {};
  awaiting_ = replied_ = homed_ = lost_its_zero_ = posed_ = false;
  silent_requests_ = bad_counts_ = 0;
  sequence_ = 0;
  return std::nullopt;
}

bool FalconDriver::received(std::span<const std::byte> bytes, std::uint64_t /*now_ns*/,
                            DeviceState& out) noexcept {
  std::array<std::byte, kTransferBytes> transfer;
  const std::size_t length = std::min(bytes.size(), transfer.size());
  std::copy_n(bytes.begin(), length, transfer.begin());
  const std::size_t payload = strip_status(std::span(transfer).first(length));
  const std::size_t replies = parser_.feed(std::span(transfer).first(payload));
  // A reply that nobody waits for belongs to a request that was given up: its age is unknown.
  if (replies == 0 || !awaiting_) return false;
  awaiting_ = false;
  replied_ = true;
  silent_requests_ = 0;
  return take(parser_.newest(), out);
}

bool FalconDriver::take(const Reply& reply, DeviceState& out) noexcept {
  const bool was_homed = homed_;
  homed_ = reply.is_homed();
  lost_its_zero_ = lost_its_zero_ || (was_homed && !homed_);
  posed_ = false;
  // The coordinates jump with the reply that ends the homing: it is the first to be relied on.
  if (homed_) {
    theta_ = angles_of(reply.counts);
    posed_ = forward(theta_, position_m_);
    bad_counts_ = posed_ ? 0 : bad_counts_ + 1;
    if (!posed_) return false;
  }
  out = {};
  out.sequence = ++sequence_;
  // The encoders were read after the request left: the reading is at most as old as this.
  out.time_ns = sent_ns_;
  if (posed_) out.pose.position_m = position_m_ - kMiddle_m;
  out.buttons = reply.buttons;
  out.homing = !homed_;
  return true;
}

std::size_t FalconDriver::poll(const DeviceCommand& command, bool /*fresh*/, std::uint64_t now_ns,
                               OutBuffer& out) noexcept {
  if (awaiting_) {
    if (now_ns - sent_ns_ < kReplyWithin_ns) return 0;
    ++silent_requests_;
    ++sequence_;
    parser_.restart();
  }
  Request request;
  request.homing = true;
  request.leds = homed_ ? kGreenLed : kRedLed;
  if (now_ns < command.expires_ns) request.motors = motors_for(command.wrench);
  awaiting_ = true;
  sent_ns_ = now_ns;
  return copy(encode(request), out);
}

MotorValues FalconDriver::motors_for(const Wrench& wrench) const noexcept {
  Mat3d rows;
  Vec3d torque_Nm;
  if (!posed_ || !jacobian(position_m_, theta_, rows) ||
      !torques_of(wrench.force_N, rows, torque_Nm)) {
    return {};
  }
  return motor_values(torque_Nm);
}

std::size_t FalconDriver::farewell(OutBuffer& out) noexcept { return copy(encode(Request{}), out); }

void FalconDriver::end(Transport& /*transport*/) noexcept {}

std::uint32_t FalconDriver::faults(std::uint64_t /*now_ns*/) const noexcept {
  std::uint32_t faults = kNoDeviceFault;
  if (silent_requests_ >= kSilentRequestsToFault) faults |= kDeviceLost;
  if (lost_its_zero_ || bad_counts_ >= kBadCountsToFault) faults |= kDeviceBadReading;
  return faults;
}

double FalconDriver::first_reading_within_s() const noexcept { return kFirstReadingWithin_s; }

DeviceProblem FalconDriver::why_no_reading() const {
  if (!replied_)
    return {"first reading", "the firmware does not answer", "plug the device in again"};
  return {"first reading", "its encoders stand where no arm can be", "home it again"};
}

}  // namespace palpate::hal::falcon
