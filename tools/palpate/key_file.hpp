// SPDX-License-Identifier: GPL-3.0-or-later
// Ed25519 keys in PEM files, as OpenSSL writes and reads them (RFC 8410).
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include "hal/signature/ed25519.hpp"

namespace palpate::cli {

/// The 32 bytes that a pair of keys is made from: the secret.
using Seed = std::array<std::byte, 32>;

[[nodiscard]] std::string secret_pem(const Seed& seed);
[[nodiscard]] std::string public_pem(const hal::signature::PublicKey& key);

/// Throw std::runtime_error, naming the reason, where the file cannot be read or is no such key.
[[nodiscard]] Seed read_secret_pem(const std::filesystem::path& file);
[[nodiscard]] hal::signature::PublicKey read_public_pem(const std::filesystem::path& file);

}  // namespace palpate::cli
