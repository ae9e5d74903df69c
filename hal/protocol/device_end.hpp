// SPDX-License-Identifier: Apache-2.0
// The device's half of the open protocol, for firmware: which commands are obeyed, for how long,
// and what every reading says about it. Freestanding; knows no clock, no USB and no motors.
//
// Firmware calls receive() with each OUT packet, output() in each period of its motor loop, and
// stamp() before it sends a reading. All on one thread, or with interrupts masked. Whatever happens
// to the host, output() is zero when the command in force is over: that is the watchdog.
#pragma once

#include <cstdint>
#include <span>

#include "hal/protocol/packets.hpp"

namespace palpate::hal::protocol {

/// Health that forbids any force, until a new session finds it gone.
inline constexpr std::uint16_t kFaultHealth = kBadSensor | kMotorFailure;

class DeviceEnd {
 public:
  explicit DeviceEnd(const Capabilities& capabilities) noexcept : capabilities_(capabilities) {}

  /// The host's session request. Commands are counted anew; no force until one enables it. Readings
  /// count on: one of before may still be under way.
  void begin_session() noexcept;

  /// The host's session request, or the bus was reset, suspended or unplugged. No force.
  void end_session() noexcept;

  /// One OUT packet. Refused packets are counted and change nothing else: bad ones, repeated and
  /// overtaken ones, of the wrong kind, outside a session, and those computed from a reading that
  /// was older than Capabilities::max_state_age_us.
  /// @param now_ns  device clock  @return true where it was accepted
  bool receive(std::span<const std::byte> packet, std::uint64_t now_ns) noexcept;

  /// What the motors are to render now: the command in force, its vectors (its joint torques
  /// each) cut to the device's limits; all zero where there is none. O(1).
  [[nodiscard]] const Command& output(std::uint64_t now_ns) noexcept;

  /// Fills in what this class knows of a reading: sequence, answered, health, mode, refused. Counts
  /// the reading.
  void stamp(State& reading) noexcept;

  /// What the device finds out about itself; see Health. A bit of kFaultHealth ends the force at
  /// once.
  void set_health(std::uint16_t health) noexcept;

  /// True until the device knows its zero: no force meanwhile.
  void set_homing(bool homing) noexcept { homing_ = homing; }

  [[nodiscard]] Mode mode() const noexcept;

 private:
  [[nodiscard]] bool is_stale(const Command& command) const noexcept;
  [[nodiscard]] Command limited(const Command& command) const noexcept;

  Capabilities capabilities_;
  bool in_session_ = false;
  bool homing_ = false;
  bool faulted_ = false;
  Mode mode_ = Mode::idle;  ///< idle, active or expired
  std::uint16_t health_ = kHealthy;
  std::uint32_t readings_ = 0;
  std::uint32_t answered_ = 0;
  std::uint32_t refused_ = 0;
  std::uint64_t expires_ns_ = 0;
  Command command_;
};

}  // namespace palpate::hal::protocol
