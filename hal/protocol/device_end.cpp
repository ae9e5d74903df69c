// SPDX-License-Identifier: Apache-2.0
#include "hal/protocol/device_end.hpp"

namespace palpate::hal::protocol {
namespace {

constexpr std::uint64_t kNsPerUs = 1000;
constexpr Command kNoForce;

std::int32_t limited_to(std::int32_t value, std::uint32_t limit) noexcept {
  const std::int64_t most = limit;
  const std::int64_t v = value;
  return static_cast<std::int32_t>(v > most ? most : v < -most ? -most : v);
}

/// Scaled down to a length, every component rounded towards zero.
void limit_length(std::array<std::int32_t, 3>& v, std::uint32_t limit) noexcept {
  const auto square = [](std::int64_t x) { return static_cast<std::uint64_t>(x * x); };
  const std::uint64_t squared = square(v[0]) + square(v[1]) + square(v[2]);
  const std::uint64_t allowed = square(limit);
  if (squared <= allowed) return;
  // The greatest fraction n / 2^30 that keeps the length, by halving: integers give the same bits
  // on every processor, and there is no square root to ask for.
  constexpr int kBits = 30;
  std::int64_t fraction = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    const std::int64_t trial = fraction + (std::int64_t{1} << bit);
    std::uint64_t length = 0;
    for (const std::int32_t c : v) length += square((c * trial) / (std::int64_t{1} << kBits));
    if (length <= allowed) fraction = trial;
  }
  for (std::int32_t& c : v) {
    c = static_cast<std::int32_t>((c * fraction) / (std::int64_t{1} << kBits));
  }
}

}  // namespace

void DeviceEnd::begin_session() noexcept {
  end_session();
  in_session_ = true;
  faulted_ = (health_ & kFaultHealth) != 0;
  answered_ = refused_ = 0;
}

void DeviceEnd::end_session() noexcept {
  in_session_ = false;
  mode_ = Mode::idle;
  command_ = kNoForce;
}

bool DeviceEnd::receive(std::span<const std::byte> packet, std::uint64_t now_ns) noexcept {
  Command command;
  const bool sound = decode(packet, command) == PacketError::none;
  const bool of_my_kind = command.is_joint_command == (capabilities_.joints > 0);
  const bool newer = answered_ == 0 || is_after(command.sequence, answered_);
  if (!sound || !in_session_ || !of_my_kind || !newer || command.sequence == 0 ||
      is_stale(command)) {
    ++refused_;
    return false;
  }
  answered_ = command.sequence;
  if (!command.enable) {
    mode_ = Mode::idle;
  } else if (output(now_ns).enable || mode_ == Mode::idle) {
    const std::uint32_t life_us =
        command.life_us < capabilities_.max_life_us ? command.life_us : capabilities_.max_life_us;
    mode_ = Mode::active;
    expires_ns_ = now_ns + life_us * kNsPerUs;
    command_ = limited(command);
  }
  return true;
}

const Command& DeviceEnd::output(std::uint64_t now_ns) noexcept {
  // Ended for good: a late command must not make the force jump back.
  if (mode_ == Mode::active && now_ns >= expires_ns_) mode_ = Mode::expired;
  return mode() == Mode::active ? command_ : kNoForce;
}

void DeviceEnd::stamp(State& reading) noexcept {
  ++readings_;
  // 0 is "none" on the wire.
  if (readings_ == 0) readings_ = 1;
  reading.sequence = readings_;
  reading.answered = answered_;
  reading.health = health_;
  reading.mode = mode();
  reading.refused = refused_;
}

void DeviceEnd::set_health(std::uint16_t health) noexcept {
  health_ = health;
  faulted_ = faulted_ || (health & kFaultHealth) != 0;
}

Mode DeviceEnd::mode() const noexcept {
  if (faulted_) return Mode::fault;
  return homing_ ? Mode::homing : mode_;
}

bool DeviceEnd::is_stale(const Command& command) const noexcept {
  if (!command.enable) return false;
  if (command.answers == 0 || command.state_age_us > capabilities_.max_state_age_us) return true;
  // The age on the host leaves out the way there and back; the count of readings since covers it.
  constexpr std::uint64_t kUsPerSecond = 1'000'000;
  const std::uint64_t allowed =
      std::uint64_t{capabilities_.max_state_age_us} * capabilities_.rate_Hz / kUsPerSecond + 1;
  return readings_ - command.answers > allowed;
}

Command DeviceEnd::limited(const Command& command) const noexcept {
  Command c = command;
  limit_length(c.force_uN, capabilities_.max_force_uN);
  limit_length(c.torque_uNm, capabilities_.max_torque_uNm);
  for (std::int32_t& torque : c.joint_torque_uNm) {
    torque = limited_to(torque, capabilities_.max_torque_uNm);
  }
  return c;
}

}  // namespace palpate::hal::protocol
