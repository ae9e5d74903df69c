// SPDX-License-Identifier: GPL-3.0-or-later
// palpate key: a pair of keys for signing images, and its public half for devices.
#include <sys/stat.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "tools/palpate/command.hpp"
#include "tools/palpate/signing.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

struct KeyOptions {
  fs::path key;
  bool make = false;
  fs::path public_pem;
  fs::path c_source;
};

/// An initialiser for hal::signature::PublicKey, or of any array of bytes.
std::string c_text(const hal::signature::PublicKey& key) {
  constexpr const char* kHex = "0123456789abcdef";
  std::string text = "/* The public key that a device accepts images of. */\n";
  text += "static const unsigned char palpate_public_key[32] = {";
  for (std::size_t i = 0; i < key.size(); ++i) {
    const auto value = std::to_integer<unsigned>(key[i]);
    text += (i % 8 == 0 ? "\n  0x" : " 0x");
    text += kHex[value >> 4];
    text += kHex[value & 15];
    text += ',';
  }
  return text + "\n};\n";
}

void key(const KeyOptions& options) {
  if (options.make) {
    if (fs::exists(options.key)) {
      throw Failure(kUsage, "there is a file of this name already", options.key.string(),
                    "choose another: a key that is lost cannot be made again");
    }
    // Nobody else may read it at any time.
    const mode_t before = ::umask(0077);
    write_file(options.key, secret_pem(new_seed()));
    ::umask(before);
  }
  const auto public_key = public_key_of(load_seed(options.key));
  if (!options.public_pem.empty()) write_file(options.public_pem, public_pem(public_key));
  if (!options.c_source.empty()) write_file(options.c_source, c_text(public_key));
  std::cout << public_pem(public_key);
}

}  // namespace

void add_key(CLI::App& app) {
  auto options = std::make_shared<KeyOptions>();
  CLI::App* command = app.add_subcommand(
      "key", "Print the public half of a key for signing images; make one with --new");
  command->add_option("KEY", options->key, "the secret key, a PEM file")->required();
  command->add_flag("--new", options->make, "make the secret key, for its owner alone to read");
  command->add_option("--public", options->public_pem, "write the public half as PEM");
  command->add_option("--c", options->c_source, "write the public half as C source, for firmware");
  command->callback([options] { key(*options); });
}

}  // namespace palpate::cli
