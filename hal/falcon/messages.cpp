// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/messages.hpp"

#include <algorithm>

namespace palpate::hal::falcon {
namespace {

constexpr std::byte kFirst{'<'};
constexpr std::byte kLast{'>'};
constexpr std::uint8_t kBase = 'A';
constexpr std::size_t kNumbersAt = 1;
constexpr std::size_t kFlagsAt = 13;
constexpr std::size_t kUnknownAt = 14;
constexpr std::size_t kNibbles = 4;
constexpr std::uint8_t kHomingFlag = 0x1;
constexpr std::uint8_t kLedFlags = 0xe;

using Numbers = std::array<std::int16_t, 3>;

std::byte letter(unsigned value) noexcept { return static_cast<std::byte>(kBase + value); }

/// Byte less 'A'; at least 256 where it is below 'A'.
unsigned value_of(std::byte b) noexcept { return std::to_integer<unsigned>(b) - kBase; }

Message framed(const Numbers& numbers, unsigned flags) noexcept {
  Message m;
  m[0] = kFirst;
  std::size_t at = kNumbersAt;
  for (const std::int16_t number : numbers) {
    for (std::size_t i = 0; i < kNibbles; ++i) {
      m[at++] = letter(static_cast<std::uint16_t>(number) >> (4 * i) & 15u);
    }
  }
  m[kFlagsAt] = letter(flags);
  m[kUnknownAt] = letter(0);
  m[kMessageBytes - 1] = kLast;
  return m;
}

bool read_frame(const Message& m, Numbers& numbers, unsigned& flags) noexcept {
  if (m[0] != kFirst || m[kMessageBytes - 1] != kLast) return false;
  std::size_t at = kNumbersAt;
  for (std::int16_t& number : numbers) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < kNibbles; ++i) {
      const unsigned nibble = value_of(m[at++]);
      if (nibble > 15) return false;
      bits |= nibble << (4 * i);
    }
    number = static_cast<std::int16_t>(bits);
  }
  flags = value_of(m[kFlagsAt]);
  return true;
}

}  // namespace

Message encode(const Request& request) noexcept {
  Numbers motors = request.motors;
  for (std::int16_t& m : motors) {
    m = std::clamp<std::int16_t>(m, -kMaxMotorValue, kMaxMotorValue);
  }
  return framed(motors, (request.homing ? kHomingFlag : 0u) | (request.leds & kLedFlags));
}

Message encode(const Reply& reply) noexcept {
  return framed(reply.counts, (reply.buttons & 15u) | (reply.homed & 7u) << 4);
}

bool decode(const Message& message, Request& out) noexcept {
  Numbers motors{};
  unsigned flags = 0;
  if (!read_frame(message, motors, flags) || flags > 15) return false;
  out = {motors, (flags & kHomingFlag) != 0, static_cast<std::uint8_t>(flags & kLedFlags)};
  return true;
}

bool decode(const Message& message, Reply& out) noexcept {
  Numbers counts{};
  unsigned flags = 0;
  if (!read_frame(message, counts, flags) || flags > 127) return false;
  out = {counts, static_cast<std::uint8_t>(flags & 15), static_cast<std::uint8_t>(flags >> 4)};
  return true;
}

std::size_t ReplyParser::feed(std::span<const std::byte> bytes) noexcept {
  std::size_t replies = 0;
  for (const std::byte b : bytes) {
    if (filled_ == 0 && b != kFirst) {
      ++skipped_;
      continue;
    }
    window_[filled_++] = b;
    if (filled_ < kMessageBytes) continue;
    if (decode(window_, newest_)) {
      ++replies;
      filled_ = 0;
    } else {
      search_again();
    }
  }
  return replies;
}

void ReplyParser::restart() noexcept {
  skipped_ += filled_;
  filled_ = 0;
}

void ReplyParser::search_again() noexcept {
  const auto next = std::find(window_.begin() + 1, window_.end(), kFirst);
  skipped_ += static_cast<std::uint64_t>(next - window_.begin());
  filled_ = static_cast<std::size_t>(window_.end() - next);
  std::copy(next, window_.end(), window_.begin());
}

}  // namespace palpate::hal::falcon
