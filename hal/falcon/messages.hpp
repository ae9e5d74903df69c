// SPDX-License-Identifier: Apache-2.0
// The Falcon's run-time messages: 16 bytes out for 16 bytes back; the device never speaks first.
//
// Byte 0 is '<', byte 15 is '>'. Bytes 1 to 12 hold three signed 16-bit numbers, a nibble a byte,
// lowest first, each + 'A'. Byte 13 is 'A' + flags, byte 14 has no known meaning.
// Source: the libnifalcon project's FalconFirmwareNovintSDK (its code, where its comments differ).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/falcon/kinematics.hpp"

namespace palpate::hal::falcon {

inline constexpr std::size_t kMessageBytes = 16;
using Message = std::array<std::byte, kMessageBytes>;

/// What the host asks for.
struct Request {
  MotorValues motors{};
  bool homing = false;    ///< look for the encoders' zero
  std::uint8_t leds = 0;  ///< bits 1 to 3: green, blue, red; others are left out
};

/// What the device answers.
struct Reply {
  EncoderCounts counts{};
  std::uint8_t buttons = 0;  ///< bits: 0 plus, 1 forward, 2 centre, 3 minus
  std::uint8_t homed = 0;    ///< bit i: encoder i knows its zero
  [[nodiscard]] bool is_homed() const noexcept { return homed == 7; }
};

/// Motor values are cut to kMaxMotorValue.
[[nodiscard]] Message encode(const Request& request) noexcept;
[[nodiscard]] Message encode(const Reply& reply) noexcept;

/// False, and `out` untouched, where the bytes are no message: frame, nibbles or flags out of
/// range.
[[nodiscard]] bool decode(const Message& message, Request& out) noexcept;
[[nodiscard]] bool decode(const Message& message, Reply& out) noexcept;

/// Finds replies in a stream of bytes, however it is cut into transfers and whatever lies between
/// them. A message is taken where both of its ends and everything between are right; after a wrong
/// one the search goes on at the next '<' inside it, so that one lost byte costs one reply.
/// Reads at most the newest bytes that a reply can be made of; nothing of an old one is ever mixed
/// in.
class ReplyParser {
 public:
  /// Takes bytes; how many replies ended in them. The newest is in newest(). O(bytes).
  std::size_t feed(std::span<const std::byte> bytes) noexcept;
  [[nodiscard]] const Reply& newest() const noexcept { return newest_; }

  /// Bytes that were in no reply.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

  /// Forgets a reply that has begun: before a request is repeated.
  void restart() noexcept;

 private:
  void search_again() noexcept;

  Message window_{};  ///< what may be a reply, from its '<' on
  std::size_t filled_ = 0;
  Reply newest_;
  std::uint64_t skipped_ = 0;
};

}  // namespace palpate::hal::falcon
