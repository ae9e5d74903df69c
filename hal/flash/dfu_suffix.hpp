// SPDX-License-Identifier: Apache-2.0
// The 16 bytes at the end of a DFU file that say which device it is for (USB DFU 1.1, Appendix B).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace palpate::hal::flash {

inline constexpr std::size_t kSuffixBytes = 16;
inline constexpr std::uint16_t kAnyId = 0xffff;

struct DfuSuffix {
  std::uint16_t vendor = kAnyId;
  std::uint16_t product = kAnyId;
  std::uint16_t device_version = kAnyId;  ///< bcdDevice
};

/// The suffix of a file that holds these bytes before it.
[[nodiscard]] std::array<std::byte, kSuffixBytes> make_suffix(std::span<const std::byte> contents,
                                                              const DfuSuffix& suffix) noexcept;

/// The suffix of a whole file; absent where its signature, length, version or CRC is wrong.
[[nodiscard]] std::optional<DfuSuffix> read_suffix(std::span<const std::byte> file) noexcept;

}  // namespace palpate::hal::flash
