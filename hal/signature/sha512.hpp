// SPDX-License-Identifier: Apache-2.0
// SHA-512 (FIPS 180-4), freestanding: what Ed25519 is made of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::hal::signature {

/// 896 bytes of stack in block(), none else of note.
class Sha512 {
 public:
  void update(std::span<const std::byte> data) noexcept;
  [[nodiscard]] std::array<std::byte, 64>
  finish() noexcept;  ///< once; the object is spent afterwards

 private:
  void block() noexcept;
  std::array<std::uint64_t, 8> state_{0x6a09e667f3bcc908, 0xbb67ae8584caa73b, 0x3c6ef372fe94f82b,
                                      0xa54ff53a5f1d36f1, 0x510e527fade682d1, 0x9b05688c2b3e6c1f,
                                      0x1f83d9abfb41bd6b, 0x5be0cd19137e2179};
  std::array<std::byte, 128> buffer_{};
  std::size_t buffered_ = 0;
  std::uint64_t total_ = 0;  ///< bytes
};

}  // namespace palpate::hal::signature
