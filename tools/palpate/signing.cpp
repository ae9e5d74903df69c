// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/signing.hpp"

#include <stdexcept>
#include <string>

#include "hal/signature/signed_image.hpp"
#include "tools/palpate/command.hpp"

#ifdef PALPATE_SODIUM
#include <sodium.h>
#endif

namespace palpate::cli {
namespace {

using hal::signature::PublicKey;
using hal::signature::Signature;

#ifdef PALPATE_SODIUM

unsigned char* raw(std::span<std::byte> bytes) {
  return reinterpret_cast<unsigned char*>(bytes.data());
}

/// The secret in libsodium's form; wiped when it is no longer needed.
struct KeyPair {
  explicit KeyPair(Seed seed) {
    crypto_sign_seed_keypair(raw(key), secret.data(), raw(seed));
    sodium_memzero(seed.data(), seed.size());
  }
  ~KeyPair() { sodium_memzero(secret.data(), secret.size()); }
  KeyPair(const KeyPair&) = delete;
  KeyPair& operator=(const KeyPair&) = delete;
  KeyPair(KeyPair&&) = delete;
  KeyPair& operator=(KeyPair&&) = delete;

  PublicKey key{};
  std::array<unsigned char, crypto_sign_SECRETKEYBYTES> secret{};
};

void make_ready() {
  if (sodium_init() < 0) {
    throw Failure(kOther, "libsodium cannot be used", "this host", "see its documentation");
  }
}

Seed random_seed() {
  make_ready();
  Seed seed{};
  randombytes_buf(seed.data(), seed.size());
  return seed;
}

PublicKey derive(const Seed& seed) {
  make_ready();
  return KeyPair(seed).key;
}

Signature sign(const Seed& seed, const hal::signature::Statement& statement) {
  make_ready();
  const KeyPair pair(seed);
  Signature out{};
  crypto_sign_detached(raw(out), nullptr, reinterpret_cast<const unsigned char*>(statement.data()),
                       statement.size(), pair.secret.data());
  return out;
}

#else

[[noreturn]] void cannot() {
  throw Failure(kOther, "this build cannot sign", "it was made without libsodium",
                "install libsodium-dev and build again");
}
Seed random_seed() { cannot(); }
PublicKey derive(const Seed& /*seed*/) { cannot(); }
Signature sign(const Seed& /*seed*/, const hal::signature::Statement& /*statement*/) { cannot(); }

#endif

}  // namespace

void add_sign_options(CLI::App& command, SignOptions& options, const std::string& prefix) {
  CLI::Option* key = command.add_option("--sign", options.key,
                                        prefix + "sign with this secret key (palpate key --new)");
  command
      .add_option("--counter", options.counter,
                  prefix +
                      "security counter of the signature: devices refuse lower ones than they "
                      "have confirmed")
      ->needs(key)
      ->capture_default_str();
}

Seed new_seed() { return random_seed(); }

PublicKey public_key_of(const Seed& seed) { return derive(seed); }

Seed load_seed(const std::filesystem::path& file) {
  try {
    return read_secret_pem(file);
  } catch (const std::runtime_error& e) {
    throw Failure(kRefused, std::string("not a secret key, ") + e.what(), file.string(),
                  "make one with 'palpate key --new FILE'");
  }
}

std::vector<std::byte> with_signature(std::span<const std::byte> image,
                                      const SignOptions& options) {
  std::vector<std::byte> file(image.begin(), image.end());
  if (options.key.empty()) return file;
  const auto statement = hal::signature::statement_of(image, options.counter);
  const Signature signature = sign(load_seed(options.key), statement);
  file.insert(file.end(), statement.begin(), statement.end());
  file.insert(file.end(), signature.begin(), signature.end());
  return file;
}

}  // namespace palpate::cli
