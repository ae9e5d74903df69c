// SPDX-License-Identifier: Apache-2.0
#include "hal/signature/signed_image.hpp"

#include "hal/protocol/bytes.hpp"
#include "rt_core/image/sha256.hpp"

namespace palpate::hal::signature {
namespace {

// Offsets within a block.
constexpr std::size_t kMagicAt = 0;
constexpr std::size_t kVersionAt = 8;
constexpr std::size_t kSizeAt = 12;
constexpr std::size_t kCounterAt = 16;
constexpr std::size_t kHashAt = 32;
constexpr std::size_t kSignatureAt = 64;

constexpr std::uint64_t kMagic = 0x4e474953504c4150;  // "PALPSIGN"
constexpr std::uint32_t kVersion = 1;

}  // namespace

Statement statement_of(std::span<const std::byte> image, std::uint64_t counter) noexcept {
  Statement out{};
  const std::span<std::byte> bytes(out);
  put(bytes, kMagicAt, kMagic);
  put(bytes, kVersionAt, kVersion);
  put(bytes, kSizeAt, static_cast<std::uint32_t>(image.size()));
  put(bytes, kCounterAt, counter);
  Sha256 hash;
  hash.update(image);
  const auto digest = hash.finish();
  for (std::size_t i = 0; i < digest.size(); ++i) out[kHashAt + i] = std::byte{digest[i]};
  return out;
}

Contents contents_of(std::span<const std::byte> file) noexcept {
  Contents out;
  out.image = file;
  if (file.size() < kBlockBytes) return out;
  const auto block = file.last(kBlockBytes);
  const std::size_t image_bytes = file.size() - kBlockBytes;
  const bool is_block = get<std::uint64_t>(block, kMagicAt) == kMagic &&
                        get<std::uint32_t>(block, kVersionAt) == kVersion &&
                        get<std::uint32_t>(block, kSizeAt) == image_bytes;
  if (!is_block) return out;
  out.image = file.first(image_bytes);
  out.block = block;
  out.counter = get<std::uint64_t>(block, kCounterAt);
  return out;
}

bool is_signed_by(const PublicKey& key, const Contents& contents) noexcept {
  if (contents.block.size() != kBlockBytes) return false;
  const Statement right = statement_of(contents.image, contents.counter);
  for (std::size_t i = 0; i < right.size(); ++i) {
    if (contents.block[i] != right[i]) return false;
  }
  Signature signature{};
  for (std::size_t i = 0; i < signature.size(); ++i) {
    signature[i] = contents.block[kSignatureAt + i];
  }
  return verify(key, right, signature);
}

}  // namespace palpate::hal::signature
