// SPDX-License-Identifier: Apache-2.0
// SHA-256 (FIPS 180-4), freestanding: the same code runs on the host and behind a bootloader.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate {

class Sha256 {
 public:
  void update(std::span<const std::byte> data) noexcept;
  [[nodiscard]] std::array<std::uint8_t, 32>
  finish() noexcept;  ///< once; the object is spent afterwards

 private:
  void block(const std::byte* data) noexcept;
  std::uint32_t state_[8] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                             0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::byte buffer_[64]{};
  std::size_t buffered_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace palpate
