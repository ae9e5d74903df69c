// SPDX-License-Identifier: Apache-2.0
// The packets of the open protocol for six-axis devices, version 1: what docs/PROTOCOL.md
// specifies, as plain structs, and the one codec that both ends use. Freestanding: no heap, no
// libm, O(1).
//
// Every packet has 64 bytes, so that it is one USB transaction at full and at high speed. Numbers
// are little-endian integers in fixed units: there is no NaN on the wire.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::hal::protocol {

inline constexpr std::uint8_t kVersion = 1;  ///< another number is refused
inline constexpr std::size_t kPacketBytes = 64;
inline constexpr std::size_t kMaxJoints = 7;
inline constexpr std::int32_t kUnitQuaternion = 1 << 30;  ///< what a component of 1 is on the wire
inline constexpr std::uint32_t kMaxCommandLife_us = 100'000;
inline constexpr std::uint8_t kNoSlot = 0xff;

using Packet = std::array<std::byte, kPacketBytes>;

/// Byte 3 of a packet. Numbers are stable.
enum class PacketType : std::uint8_t {
  pose_state = 0x01,      ///< device to host
  joint_state = 0x02,     ///< device to host
  wrench_command = 0x41,  ///< host to device
  joint_command = 0x42,   ///< host to device
  capabilities = 0x81,    ///< device to host, on request
  joint = 0x82,           ///< device to host, on request
  image_identity = 0x83,  ///< device to host, on request
};

/// Why bytes are no packet, in the order in which it is looked at.
enum class [[nodiscard]] PacketError : std::uint8_t{
    none = 0,
    size = 1,      ///< not kPacketBytes
    magic = 2,     ///< the first two bytes are not 'P' 'p'
    version = 3,   ///< another version of the protocol
    type = 4,      ///< not the type asked for
    crc = 5,       ///< damaged on the way
    reserved = 6,  ///< a reserved byte is not zero
    range = 7,     ///< a field is out of its range
};

/// Static storage, never null.
[[nodiscard]] const char* describe(PacketError error) noexcept;

/// What the device is doing. Numbers are stable.
enum class Mode : std::uint8_t {
  idle = 0,     ///< no session, or none that was enabled: no force
  homing = 1,   ///< finding its zero: no force from commands, readings are not to be relied on
  active = 2,   ///< renders commands
  expired = 3,  ///< the host fell silent: no force until it has disabled and enabled again
  fault = 4,    ///< see health: no force until a new session
};

/// Bits of State::health. Numbers are stable.
enum Health : std::uint16_t {
  kHealthy = 0,
  kOverheated = 1u << 0,    ///< it has reduced its force to protect itself
  kBadSensor = 1u << 1,     ///< a sensor's reading cannot be right
  kMotorFailure = 1u << 2,  ///< a motor or its power
  kLimitReached = 1u << 3,  ///< a joint is at its end
  kNoImage = 1u << 4,       ///< it computes contacts itself and holds no valid image
  kKnownHealth = (1u << 5) - 1
};

/// A reading. Where the device has joints of its own (Capabilities::joints > 0), `joint_counts`
/// counts and the pose is not sent; else the other way round.
struct State {
  bool is_joint_state = false;
  std::uint32_t sequence = 0;        ///< counts readings since power-up from 1, wraps past 0
  std::uint64_t device_time_ns = 0;  ///< when the reading was taken, on the device's clock
  std::array<std::int32_t, 3> position_nm{};
  /// w x y z, in 1 / kUnitQuaternion; length within 1/1024 of 1
  std::array<std::int32_t, 4> orientation{kUnitQuaternion, 0, 0, 0};
  std::array<std::int32_t, kMaxJoints> joint_counts{};
  std::uint32_t buttons = 0;
  std::uint32_t answered = 0;  ///< sequence of the newest command accepted; 0: none yet
  std::uint16_t health = kHealthy;
  Mode mode = Mode::idle;
  std::uint32_t refused = 0;  ///< packets of the host that were refused in this session
};

/// What the device is to render.
struct Command {
  bool is_joint_command = false;
  std::uint32_t sequence = 0;                ///< counts commands of a session from 1, wraps past 0
  std::uint32_t life_us = 0;                 ///< from its arrival; 1 to kMaxCommandLife_us
  bool enable = false;                       ///< false: no force, and a way out of Mode::expired
  std::array<std::int32_t, 3> force_uN{};    ///< on the tool, base axes
  std::array<std::int32_t, 3> torque_uNm{};  ///< about the tool's origin, base axes
  std::array<std::int32_t, kMaxJoints> joint_torque_uNm{};
  std::uint32_t answers = 0;       ///< sequence of the reading it was computed from; 0: none
  std::uint32_t state_age_us = 0;  ///< of that reading, when the command was computed
};

/// What the device is; the same for as long as it is plugged in.
struct Capabilities {
  std::uint8_t sensed_dof = 6;    ///< 3 or 6
  std::uint8_t rendered_dof = 6;  ///< 3 or 6
  std::uint8_t joints = 0;        ///< 0: it sends poses and takes wrenches; else 1 to kMaxJoints
  std::uint8_t slots = 0;         ///< of images; 0 or 2
  std::uint32_t rate_Hz = 0;      ///< readings a second, 1 to 20000
  std::uint32_t max_force_uN = 0;
  std::uint32_t max_torque_uNm = 0;
  std::uint32_t max_life_us = 0;           ///< longer lives are cut; 1 to kMaxCommandLife_us
  std::uint32_t max_state_age_us = 0;      ///< commands that answer older readings are refused
  std::uint32_t image_capacity_bytes = 0;  ///< of one slot
  std::uint32_t engine_memory_bytes = 0;   ///< what it can give a contact engine
};

/// One joint of a serial chain, base first. Angles in 2^-31 half-turns (the whole range of 32 bits
/// is one turn). Craig's modified Denavit-Hartenberg parameters.
struct Joint {
  std::uint8_t index = 0;
  std::int32_t a_nm = 0;
  std::int32_t d_nm = 0;
  std::int32_t alpha = 0;
  std::int32_t theta_offset = 0;
  std::int32_t counts_per_turn = 0;  ///< not 0; negative where the encoder counts backwards
  std::int32_t zero_counts = 0;      ///< calibration: the count at theta = theta_offset
  std::int32_t min_counts = 0;
  std::int32_t max_counts = 0;  ///< not below min_counts
  std::uint32_t max_torque_uNm = 0;
};

/// Which image the device would use.
struct ImageIdentity {
  std::uint8_t active_slot = kNoSlot;  ///< 0, 1 or kNoSlot
  bool confirmed = false;              ///< its self-test has passed
  std::uint16_t format_major = 0;
  std::uint32_t image_bytes = 0;
  std::uint64_t sequence = 0;                     ///< of updates; the newest is used
  std::array<std::uint8_t, 32> content_sha256{};  ///< of docs/FORMAT.md
};

[[nodiscard]] Packet encode(const State& state) noexcept;
[[nodiscard]] Packet encode(const Command& command) noexcept;
[[nodiscard]] Packet encode(const Capabilities& capabilities) noexcept;
[[nodiscard]] Packet encode(const Joint& joint) noexcept;
[[nodiscard]] Packet encode(const ImageIdentity& identity) noexcept;

/// Each checks everything there is to check, and writes `out` only where the result is none.
PacketError decode(std::span<const std::byte> bytes, State& out) noexcept;
PacketError decode(std::span<const std::byte> bytes, Command& out) noexcept;
PacketError decode(std::span<const std::byte> bytes, Capabilities& out) noexcept;
PacketError decode(std::span<const std::byte> bytes, Joint& out) noexcept;
PacketError decode(std::span<const std::byte> bytes, ImageIdentity& out) noexcept;

/// Whether sequence a comes after b, past the wrap too (RFC 1982 for 32 bits).
[[nodiscard]] constexpr bool is_after(std::uint32_t a, std::uint32_t b) noexcept {
  return static_cast<std::int32_t>(a - b) > 0;
}

// How the endpoints and requests are found: docs/PROTOCOL.md, "The USB device".
inline constexpr std::uint8_t kInterfaceClass = 0xff;
inline constexpr std::uint8_t kInterfaceSubclass = 0x50;
inline constexpr std::uint8_t kInterfaceProtocol = 0x41;
/// bRequest, to the interface. read: type IN, wValue = packet type << 8 | index, 64 bytes.
/// session: type OUT, wValue 1 begins, 0 ends, no data. restart: type OUT, no data.
enum class Request : std::uint8_t { read = 0x01, session = 0x02, restart = 0x03 };
inline constexpr std::uint8_t kVendorIn = 0xc1;   ///< bmRequestType: vendor, interface
inline constexpr std::uint8_t kVendorOut = 0x41;  ///< bmRequestType: vendor, interface

}  // namespace palpate::hal::protocol
