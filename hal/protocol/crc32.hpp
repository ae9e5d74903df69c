// SPDX-License-Identifier: Apache-2.0
// The CRC-32 of Ethernet, zlib and DFU suffixes, freestanding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::hal {

inline constexpr std::uint32_t kCrc32Start = 0xffffffffu;

/// Carries a CRC over further bytes, from kCrc32Start. Polynomial 0xedb88320, reflected. What is
/// called "the CRC-32" is the complement of the last state; a DFU suffix holds the state itself
/// (USB DFU 1.1, Appendix B).
/// Cost: two steps a byte, a table of 64 bytes.
constexpr std::uint32_t crc32_update(std::uint32_t state,
                                     std::span<const std::byte> bytes) noexcept {
  constexpr auto kTable = [] {
    std::array<std::uint32_t, 16> table{};
    for (std::uint32_t i = 0; i < 16; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 4; ++bit) {
        value = (value >> 1) ^ ((value & 1) != 0 ? 0xedb88320u : 0u);
      }
      table[i] = value;
    }
    return table;
  }();
  for (const std::byte b : bytes) {
    state ^= std::to_integer<std::uint32_t>(b);
    state = (state >> 4) ^ kTable[state & 15];
    state = (state >> 4) ^ kTable[state & 15];
  }
  return state;
}

}  // namespace palpate::hal
