// SPDX-License-Identifier: Apache-2.0
// Numbers modulo p = 2^255 - 19, freestanding. Timing depends on the values: for public ones only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::hal::signature {

/// 32 bits a limb, lowest first; any number below 2^256 that has the right rest.
struct Field {
  std::array<std::uint32_t, 8> limbs{};
};

inline constexpr Field kZero{};
inline constexpr Field kOne{{1}};

[[nodiscard]] Field operator+(const Field& a, const Field& b) noexcept;
[[nodiscard]] Field operator-(const Field& a, const Field& b) noexcept;
[[nodiscard]] Field operator*(const Field& a, const Field& b) noexcept;

/// a^(2^n).
[[nodiscard]] Field squared(Field a, int n) noexcept;
[[nodiscard]] Field inverse(const Field& a) noexcept;
/// a^((p - 5) / 8), from which square roots are made.
[[nodiscard]] Field root_power(const Field& a) noexcept;

/// The one number of its class that is below p.
[[nodiscard]] Field reduced(Field a) noexcept;
[[nodiscard]] inline bool same(const Field& a, const Field& b) noexcept {
  return reduced(a).limbs == reduced(b).limbs;
}

/// Little-endian; all 256 bits.
[[nodiscard]] Field from_bytes(std::span<const std::byte, 32> bytes) noexcept;
[[nodiscard]] std::array<std::byte, 32> to_bytes(const Field& a) noexcept;

}  // namespace palpate::hal::signature
