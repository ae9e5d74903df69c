// SPDX-License-Identifier: Apache-2.0
#include "hal/simulator/falcon_device.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hal/falcon/driver.hpp"

namespace palpate::hal::simulator {
namespace {

using namespace falcon;

constexpr double kStep_s = 0.0005;
constexpr std::uint64_t kStep_ns = 500'000;
constexpr std::uint64_t kNsPerMs = 1'000'000;
/// Arms stand this far from their zero until it has been found.
constexpr std::int16_t kUnhomedOffset = 400;

constexpr std::array kHello{std::byte{0x0a}, std::byte{0x43}, std::byte{0x0d}};
constexpr std::array kHelloReply{std::byte{0x0a}, std::byte{0x44}, std::byte{0x2c},
                                 std::byte{0x0d}};

/// What the motors give at the grip.
Wrench wrench_of(const MotorValues& motors, const Vec3d& position_m) {
  JointAngles theta{};
  Mat3d rows;
  if (!inverse(position_m + kMiddle_m, theta) || !jacobian(position_m + kMiddle_m, theta, rows)) {
    return {};
  }
  const Vec3d torque_Nm =
      (-1.0 / kMotorValuePerNm) * Vec3d{double(motors[0]), double(motors[1]), double(motors[2])};
  return {transpose(rows) * torque_Nm, {}};
}

}  // namespace

FalconDevice::FalconDevice(FalconDeviceOptions options)
    : options_(std::move(options)),
      descriptors_(falcon_descriptors(options_.serial)),
      hand_(options_.hand, kStep_s),
      processor_(options_.firmware_runs ? Processor::firmware : Processor::off) {}

void FalconDevice::advance_to(std::uint64_t now_ns) {
  if (next_step_ns_ == 0) next_step_ns_ = next_tick_ns_ = now_ns;
  for (; next_step_ns_ <= now_ns; next_step_ns_ += kStep_ns) {
    hand_.advance(wrench_of(motors_, hand_.pose().position_m));
    if (homing_) homing_s_ += kStep_s;
  }
  while (next_tick_ns_ <= now_ns) {
    tick_due_ = true;
    next_tick_ns_ += latency_ms_ * kNsPerMs;
  }
  now_ns_ = now_ns;
}

std::uint64_t FalconDevice::next_event_ns() const { return next_tick_ns_; }

IoResult FalconDevice::control_in(const ControlRequest& request, std::span<std::byte> out) {
  if (is_standard(request)) return standard_in(descriptors_, request, out);
  if (request.type != kFtdiIn || out.empty() ||
      request.request != static_cast<std::uint8_t>(FtdiRequest::get_latency)) {
    return {IoStatus::stalled};
  }
  out[0] = std::byte{latency_ms_};
  return {IoStatus::ok, 1};
}

IoResult FalconDevice::control_out(const ControlRequest& request,
                                   std::span<const std::byte> /*data*/) {
  if (is_standard(request)) return standard_out(request);
  if (request.type != kFtdiOut) return {IoStatus::stalled};
  switch (FtdiRequest{request.request}) {
    case FtdiRequest::purge:
      if (request.value == 1) said_.clear();
      return {};
    case FtdiRequest::modem:
      set_modem(request.value);
      return {};
    case FtdiRequest::baud:
      set_baud(request.value);
      return {};
    case FtdiRequest::set_latency:
      if (!options_.ignores_latency) latency_ms_ = static_cast<std::uint8_t>(request.value);
      return {};
    case FtdiRequest::flow_control:
    case FtdiRequest::line:
      return {};
    default:
      return {IoStatus::stalled};
  }
}

void FalconDevice::set_modem(std::uint16_t value) {
  const bool was_high = dtr_;
  if (value == 0x0100) dtr_ = false;
  if (value == 0x0101) dtr_ = true;
  // The rising edge resets the processor into its loader.
  if (!was_high && dtr_ && baud_ == Baud::b9600) {
    processor_ = Processor::loader;
    motors_ = {};
    homing_ = false;
    homing_s_ = 0;
  }
}

void FalconDevice::set_baud(std::uint16_t value) {
  baud_ = Baud{value};
  if (processor_ == Processor::uploading && baud_ == Baud::b1500k) {
    processor_ = options_.runs_what_it_got ? Processor::firmware : Processor::off;
  }
}

void FalconDevice::out(std::span<const std::byte> bytes) {
  if (processor_ == Processor::firmware) {
    if (baud_ == Baud::b1500k) firmware(bytes);
  } else if (processor_ != Processor::off) {
    loader(bytes);
  }
}

void FalconDevice::loader(std::span<const std::byte> bytes) {
  const bool is_hello = std::equal(bytes.begin(), bytes.end(), kHello.begin(), kHello.end());
  if (processor_ == Processor::loader && baud_ == Baud::b9600 && dtr_ && is_hello) {
    if (options_.deaf_to_hellos-- > 0) return;
    if (std::exchange(options_.zero_before_hello, false)) said_.push_back(std::byte{0});
    say(kHelloReply);
    processor_ = Processor::greeted;
  } else if (processor_ == Processor::greeted && baud_ == Baud::b140k && !dtr_ &&
             bytes.size() == 1 && bytes[0] == std::byte{0x41}) {
    say(bytes);
    uploaded_.clear();
    processor_ = Processor::uploading;
  } else if (processor_ == Processor::uploading && baud_ == Baud::b140k) {
    uploaded_.insert(uploaded_.end(), bytes.begin(), bytes.end());
    say(bytes);
    constexpr std::size_t kSpoiltAt = 500;
    if (uploaded_.size() > kSpoiltAt && options_.bad_uploads > 0) {
      --options_.bad_uploads;
      said_.back() ^= std::byte{1};
    }
  }
}

void FalconDevice::firmware(std::span<const std::byte> bytes) {
  for (const std::byte b : bytes) {
    if (heard_.empty() && b != std::byte{'<'}) continue;
    heard_.push_back(b);
    if (heard_.size() < kMessageBytes) continue;
    Message message;
    std::copy(heard_.begin(), heard_.end(), message.begin());
    heard_.clear();
    Request request;
    if (decode(message, request)) answer(request);
  }
}

void FalconDevice::answer(const Request& request) {
  motors_ = request.motors;
  homing_ = request.homing;
  Reply reply;
  JointAngles theta{};
  if (inverse(hand_.pose().position_m + kMiddle_m, theta)) reply.counts = counts_of(theta);
  if (is_homed()) {
    reply.homed = 7;
  } else {
    for (std::int16_t& count : reply.counts) {
      count = static_cast<std::int16_t>(count + kUnhomedOffset);
    }
  }
  const Message message = encode(reply);
  if (!mute_) say(std::span(message).first(kMessageBytes - shorten_by_));
}

void FalconDevice::say(std::span<const std::byte> bytes) {
  said_.insert(said_.end(), bytes.begin(), bytes.end());
}

std::size_t FalconDevice::in(std::span<std::byte> buffer) {
  // Full, or the latency timer: then what there is, if only the status.
  if (said_.size() < kMaxPayload && !tick_due_) return 0;
  if (said_.size() < kMaxPayload) tick_due_ = false;
  const std::size_t payload = std::min({said_.size(), kMaxPayload, buffer.size() - kStatusBytes});
  buffer[0] = std::byte{0x01};
  buffer[1] = std::byte{0x60};
  for (std::size_t i = 0; i < payload; ++i) {
    buffer[kStatusBytes + i] = said_.front();
    said_.pop_front();
  }
  return kStatusBytes + payload;
}

bool FalconDevice::is_homed() const noexcept { return homing_s_ >= options_.homed_after_s; }

}  // namespace palpate::hal::simulator
