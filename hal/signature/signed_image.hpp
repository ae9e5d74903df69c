// SPDX-License-Identifier: Apache-2.0
// Images with a signature: the image, and behind it a block of 128 bytes that vouches for it.
// Freestanding. docs/PROTOCOL.md, "Signed images", gives the bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/signature/ed25519.hpp"

namespace palpate::hal::signature {

inline constexpr std::size_t kBlockBytes = 128;

/// What is signed: which image, by its SHA-256 and size, and its security counter.
using Statement = std::array<std::byte, kBlockBytes - kSignatureBytes>;

/// @param counter  a device that has confirmed an image with a greater one refuses this one
[[nodiscard]] Statement statement_of(std::span<const std::byte> image,
                                     std::uint64_t counter) noexcept;

/// What is in a file that may be signed.
struct Contents {
  std::span<const std::byte> image;
  std::span<const std::byte> block;  ///< empty: it is not signed
  std::uint64_t counter = 0;         ///< as stated; only worth something where is_signed_by()
};

/// Takes the block off the end, where there is one that stands behind an image of its size. O(1).
[[nodiscard]] Contents contents_of(std::span<const std::byte> file) noexcept;

/// Whether the block is right for the image and signed with the key's other half. Cost: one pass of
/// SHA-256 and one verify().
[[nodiscard]] bool is_signed_by(const PublicKey& key, const Contents& contents) noexcept;

}  // namespace palpate::hal::signature
