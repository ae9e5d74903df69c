// SPDX-License-Identifier: Apache-2.0
// Whether an Ed25519 signature is right, freestanding: for the device, which holds a public key.
//
// Only verification is here, which handles nothing secret and so need not hide its timing. Signing
// does, and is left to libsodium on the host.
//
// Source: RFC 8032 (Josefsson and Liusvaara, 2017), 5.1; the points' formulas are those of Hisil,
// Wong, Carter and Dawson, "Twisted Edwards curves revisited", ASIACRYPT 2008. As strict as
// libsodium: S below the group's order, a key that is a point in its one encoding and of no small
// order, R compared byte for byte (the equation without cofactor).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate::hal::signature {

inline constexpr std::size_t kPublicKeyBytes = 32;
inline constexpr std::size_t kSignatureBytes = 64;
using PublicKey = std::array<std::byte, kPublicKeyBytes>;
using Signature = std::array<std::byte, kSignatureBytes>;

/// Cost: about 3900 multiplications of 256 bits, whatever the message, and its SHA-512; less than
/// 2 KiB of stack a frame. Not for the motor loop.
[[nodiscard]] bool verify(const PublicKey& key, std::span<const std::byte> message,
                          const Signature& signature) noexcept;

}  // namespace palpate::hal::signature
