// SPDX-License-Identifier: Apache-2.0
// Little-endian integers in byte arrays, whatever the byte order and alignment rules of the
// processor. Freestanding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace palpate::hal {

/// Writes sizeof(T) bytes at an offset, which must leave room for them.
template <class T>
constexpr void put(std::span<std::byte> bytes, std::size_t offset, T value) noexcept {
  static_assert(std::is_integral_v<T>);
  const auto bits = static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(value));
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[offset + i] = static_cast<std::byte>(bits >> (8 * i) & 0xff);
  }
}

/// Reads sizeof(T) bytes at an offset, which must hold them.
template <class T>
[[nodiscard]] constexpr T get(std::span<const std::byte> bytes, std::size_t offset) noexcept {
  static_assert(std::is_integral_v<T>);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bits |= std::to_integer<std::uint64_t>(bytes[offset + i]) << (8 * i);
  }
  return static_cast<T>(static_cast<std::make_unsigned_t<T>>(bits));
}

}  // namespace palpate::hal
