// SPDX-License-Identifier: Apache-2.0
// The host's half of the open protocol: packets in and readings out, commands in and packets out.
// Knows no clock and no USB.
#pragma once

#include <cstdint>
#include <span>

#include "hal/device.hpp"
#include "hal/protocol/clock_map.hpp"
#include "hal/protocol/packets.hpp"
#include "hal/protocol/serial_chain.hpp"

namespace palpate::hal::protocol {

/// What has become of the packets of a session.
struct LinkCounters {
  std::uint64_t readings = 0;  ///< used
  std::uint64_t lost = 0;      ///< missing in the sequence
  std::uint64_t refused = 0;   ///< no packets, damaged, or of no sense
  std::uint64_t outdated = 0;  ///< repeated or overtaken
};

/// Whether a device does as it is told. One that is asked for a force and renders none, for longer
/// than kWithin_ns, is a fault for the rest of the session: the hand feels nothing of what the host
/// takes to be there.
class Obedience {
 public:
  /// With the way of a reading and a tick of the loop less than 50 ms.
  static constexpr std::uint64_t kWithin_ns = 40'000'000;

  /// A command that asks for a force has left.
  void asked(std::uint32_t sequence) noexcept {
    asking_ = true;
    asked_ = sequence;
  }
  /// Nobody asks for a force any more.
  void released() noexcept { asking_ = waiting_ = false; }

  /// The time counts from the arrival of the first reading that shows no force to the taking of a
  /// later one: neither a host that stood still nor readings that were held up look like a fault.
  void judge(const State& reading, std::uint64_t time_ns, std::uint64_t arrival_ns) noexcept;

  /// One of kDeviceRefuses, kDeviceIgnores and kDeviceIdle, or none.
  [[nodiscard]] std::uint32_t fault() const noexcept { return fault_; }

 private:
  bool asking_ = false;
  bool waiting_ = false;  ///< for a reading that shows what was asked for
  std::uint64_t since_ns_ = 0;
  std::uint32_t asked_ = 0;     ///< sequence of the last command
  std::uint32_t answered_ = 0;  ///< in the newest reading
  std::uint32_t refused_ = 0;   ///< when the device last did as it was told
  std::uint32_t fault_ = kNoDeviceFault;
};

class HostEnd {
 public:
  /// @param chain  of a device with joints; without joints for one that sends poses
  explicit HostEnd(const Capabilities& capabilities, const SerialChain& chain = {}) noexcept
      : capabilities_(capabilities), chain_(chain) {}

  /// A packet that has come in. True, and `out` written, where it is a newer reading; while the
  /// device is homing its pose is left at the origin. Its faults hold what the device says of
  /// itself, and whether it does as it is told. Packets that are refused or outdated are counted.
  /// @param arrival_ns  host clock; never runs backwards
  [[nodiscard]] bool receive(std::span<const std::byte> packet, std::uint64_t arrival_ns,
                             DeviceState& out) noexcept;

  /// The packet that asks for a command, or for no force where the command has expired, is not
  /// finite, or the newest reading says that the device is homing. The life that it gives the
  /// device is what is left of the command's own, at most the device's; forces beyond the wire's
  /// range are cut to it.
  [[nodiscard]] Packet command(const DeviceCommand& command, std::uint64_t now_ns) noexcept;

  /// The packet that asks for no force.
  [[nodiscard]] Packet no_force() noexcept;

  [[nodiscard]] const LinkCounters& counters() const noexcept { return counters_; }

 private:
  Capabilities capabilities_;
  SerialChain chain_;
  JointCounts counts_{};  ///< of the newest reading
  ClockMap clock_map_;
  LinkCounters counters_;
  Obedience obedience_;
  bool homing_ = false;              ///< in the newest reading
  std::uint32_t last_sequence_ = 0;  ///< on the wire; 0: none yet
  std::uint64_t last_device_ns_ = 0;
  std::uint64_t sequence_ = 0;  ///< of the newest reading, without wrapping; from 1
  std::uint32_t commands_ = 0;
};

}  // namespace palpate::hal::protocol
