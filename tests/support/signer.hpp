// SPDX-License-Identifier: Apache-2.0
// Signatures of another implementation: libsodium's.
#pragma once

#include <sodium.h>

#include <span>
#include <vector>

#include "hal/signature/signed_image.hpp"

namespace palpate::hal::signature::test {

inline unsigned char* writable(std::span<std::byte> bytes) {
  return reinterpret_cast<unsigned char*>(bytes.data());
}
inline const unsigned char* raw(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

/// A pair of keys, and what it signs.
struct Signer {
  explicit Signer(unsigned char seed_byte) {
    const std::vector<unsigned char> seed(crypto_sign_SEEDBYTES, seed_byte);
    crypto_sign_seed_keypair(writable(key), secret.data(), seed.data());
  }
  [[nodiscard]] Signature sign(std::span<const std::byte> message) const {
    Signature out{};
    crypto_sign_detached(writable(out), nullptr, raw(message), message.size(), secret.data());
    return out;
  }
  /// The image with its block.
  [[nodiscard]] std::vector<std::byte> signed_file(std::span<const std::byte> image,
                                                   std::uint64_t counter) const {
    std::vector<std::byte> file(image.begin(), image.end());
    const Statement statement = statement_of(image, counter);
    const Signature signature = sign(statement);
    file.insert(file.end(), statement.begin(), statement.end());
    file.insert(file.end(), signature.begin(), signature.end());
    return file;
  }
  PublicKey key{};
  std::vector<unsigned char> secret = std::vector<unsigned char>(crypto_sign_SECRETKEYBYTES);
};

}  // namespace palpate::hal::signature::test
