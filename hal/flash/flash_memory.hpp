// SPDX-License-Identifier: Apache-2.0
// Flash as firmware reaches it, and the units that it is written in. Freestanding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/protocol/bytes.hpp"
#include "hal/protocol/crc32.hpp"

namespace palpate::hal::flash {

inline constexpr std::size_t kProgramBytes = 32;  ///< one program unit, or several of them
inline constexpr std::byte kErased{0xff};

/// Erased bytes are 0xff; a program unit is written once between two erasures.
class FlashMemory {
 public:
  FlashMemory() = default;
  FlashMemory(const FlashMemory&) = delete;
  FlashMemory& operator=(const FlashMemory&) = delete;
  FlashMemory(FlashMemory&&) = delete;
  FlashMemory& operator=(FlashMemory&&) = delete;

  /// Erases one erase unit. @param offset  of its first byte
  [[nodiscard]] virtual bool erase(std::uint32_t offset) noexcept = 0;
  /// Writes whole program units that are erased.
  [[nodiscard]] virtual bool program(std::uint32_t offset,
                                     std::span<const std::byte> bytes) noexcept = 0;
  /// All of it, mapped; the first byte on a 64-byte boundary.
  [[nodiscard]] virtual std::span<const std::byte> bytes() const noexcept = 0;

 protected:
  ~FlashMemory() = default;
};

using ProgramUnit = std::array<std::byte, kProgramBytes>;

[[nodiscard]] constexpr bool all_are(std::span<const std::byte> bytes, std::byte value) noexcept {
  bool all = true;
  for (const std::byte b : bytes) all = all && b == value;
  return all;
}

/// One unit with two numbers under a magic number and a CRC: what a torn write cannot pretend to
/// be.
struct Entry {
  std::uint64_t magic = 0;
  std::uint64_t first = 0;
  std::uint32_t second = 0;

  static constexpr std::size_t kCrcAt = 24;

  [[nodiscard]] constexpr ProgramUnit bytes() const noexcept {
    ProgramUnit unit{};
    const std::span<std::byte> out(unit);
    put(out, 0, magic);
    put(out, 8, first);
    put(out, 16, second);
    put(out, kCrcAt, ~crc32_update(kCrc32Start, std::span<const std::byte>(unit).first(kCrcAt)));
    return unit;
  }

  /// What stands in a unit. True where it is exactly what bytes() writes, under this magic number.
  [[nodiscard]] constexpr bool read(std::span<const std::byte> unit) noexcept {
    const Entry found{magic, get<std::uint64_t>(unit, 8), get<std::uint32_t>(unit, 16)};
    const ProgramUnit right = found.bytes();
    bool same = true;
    for (std::size_t i = 0; i < kProgramBytes; ++i) same = same && unit[i] == right[i];
    if (same) *this = found;
    return same;
  }
};

}  // namespace palpate::hal::flash
