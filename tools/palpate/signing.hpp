// SPDX-License-Identifier: GPL-3.0-or-later
// Signatures of images, made on the host by libsodium. A build without it says so.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "tools/palpate/key_file.hpp"

namespace palpate::cli {

/// --sign and --counter.
struct SignOptions {
  std::filesystem::path key;  ///< empty: nothing is signed
  std::uint64_t counter = 0;
};

/// @param prefix  before the explanations, where only some forms of a command can be signed
void add_sign_options(CLI::App& command, SignOptions& options, const std::string& prefix = "");

/// The image, with its signature behind it where one is wanted. Throws Failure: kRefused where the
/// key file is, kOther in a build that cannot sign.
[[nodiscard]] std::vector<std::byte> with_signature(std::span<const std::byte> image,
                                                    const SignOptions& options);

/// From a good source of chance. Throws Failure(kOther) in a build that cannot sign.
[[nodiscard]] Seed new_seed();

/// Throws Failure(kOther) in a build that cannot sign.
[[nodiscard]] hal::signature::PublicKey public_key_of(const Seed& seed);

/// Throws Failure(kRefused).
[[nodiscard]] Seed load_seed(const std::filesystem::path& file);

}  // namespace palpate::cli
