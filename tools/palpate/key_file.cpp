// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/key_file.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uintmax_t kMaxFileBytes = 4096;

/// What stands before the 32 bytes of a key: always the same for Ed25519.
using Bytes = std::vector<std::uint8_t>;
const Bytes& secret_head() {
  static const Bytes kHead{0x30, 0x2e, 0x02, 0x01, 0x00, 0x30, 0x05, 0x06,
                           0x03, 0x2b, 0x65, 0x70, 0x04, 0x22, 0x04, 0x20};
  return kHead;
}
const Bytes& public_head() {
  static const Bytes kHead{0x30, 0x2a, 0x30, 0x05, 0x06, 0x03, 0x2b, 0x65, 0x70, 0x03, 0x21, 0x00};
  return kHead;
}

std::string base64(const Bytes& bytes) {
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (at + i < bytes.size() ? bytes[at + i] : 0u);
    for (std::size_t i = 0; i < 4; ++i) {
      const bool is_padding = at + i > bytes.size();
      text += is_padding ? '=' : kDigits[group >> (18 - 6 * i) & 63];
    }
  }
  return text;
}

/// Nothing where it is no base64.
Bytes from_base64(std::string_view text) {
  Bytes bytes;
  std::uint32_t group = 0;
  int bits = 0;
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return {};
    group = group << 6 | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(group >> bits & 0xff));
  }
  return bytes;
}

std::string pem(const std::string& what, const Bytes& head, std::span<const std::byte, 32> key) {
  Bytes der = head;
  std::transform(key.begin(), key.end(), std::back_inserter(der),
                 [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
  return "-----BEGIN " + what + "-----\n" + base64(der) + "\n-----END " + what + "-----\n";
}

std::array<std::byte, 32> read_pem(const fs::path& file, const std::string& what,
                                   const Bytes& head) {
  std::ifstream in(file, std::ios::binary);
  std::error_code unknown;
  if (!in || fs::file_size(file, unknown) > kMaxFileBytes || unknown) {
    throw std::runtime_error("it cannot be read");
  }
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.erase(
      std::remove_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }),
      text.end());
  const std::string begin = "-----BEGIN " + what + "-----", end = "-----END " + what + "-----";
  const std::size_t from = text.find(begin), to = text.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from + begin.size()) {
    throw std::runtime_error("it is no PEM file with a " + what);
  }
  const Bytes der =
      from_base64(std::string_view(text).substr(from + begin.size(), to - from - begin.size()));
  std::array<std::byte, 32> key{};
  if (der.size() != head.size() + key.size() ||
      !std::equal(head.begin(), head.end(), der.begin())) {
    throw std::runtime_error("its key is not an Ed25519 one");
  }
  std::transform(der.begin() + static_cast<std::ptrdiff_t>(head.size()), der.end(), key.begin(),
                 [](std::uint8_t b) { return std::byte{b}; });
  return key;
}

}  // namespace

std::string secret_pem(const Seed& seed) { return pem("PRIVATE KEY", secret_head(), seed); }
std::string public_pem(const hal::signature::PublicKey& key) {
  return pem("PUBLIC KEY", public_head(), key);
}

Seed read_secret_pem(const fs::path& file) { return read_pem(file, "PRIVATE KEY", secret_head()); }
hal::signature::PublicKey read_public_pem(const fs::path& file) {
  return read_pem(file, "PUBLIC KEY", public_head());
}

}  // namespace palpate::cli
