// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "host_bake/emit/emit.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kBytesPerRecord = 16;
constexpr std::uint64_t kBank = 0x10000;  // what the 16-bit address of a record can reach

enum RecordType : std::uint8_t { kData = 0, kEndOfFile = 1, kExtendedLinearAddress = 4 };

// Appends `:LLAAAATTDD...CC`; the bytes of a record add up to 0 modulo 256.
void append_record(std::uint16_t address, RecordType type, std::span<const std::byte> data,
                   std::string& out) {
  unsigned sum = 0;
  const auto put = [&](unsigned byte) {
    constexpr char kUpperCase[] = "0123456789ABCDEF";
    out += kUpperCase[byte >> 4 & 15];
    out += kUpperCase[byte & 15];
    sum += byte;
  };
  out += ':';
  put(static_cast<unsigned>(data.size()));
  put(address >> 8);
  put(address & 255u);
  put(type);
  for (const std::byte b : data) put(std::to_integer<unsigned>(b));
  put((256 - sum % 256) % 256);
  out += '\n';
}

}  // namespace

std::string to_intel_hex(std::span<const std::byte> bytes, std::uint32_t address) {
  std::string out;
  out.reserve(bytes.size() * 11 / 4 + 64);
  std::uint64_t at = address;
  std::uint64_t bank = ~std::uint64_t{0};
  while (!bytes.empty()) {
    if (at / kBank != bank) {
      bank = at / kBank;
      const std::array<std::byte, 2> upper = {std::byte(bank >> 8), std::byte(bank & 255)};
      append_record(0, kExtendedLinearAddress, upper, out);
    }
    const std::size_t length =
        std::min({bytes.size(), kBytesPerRecord, static_cast<std::size_t>(kBank - at % kBank)});
    append_record(static_cast<std::uint16_t>(at % kBank), kData, bytes.first(length), out);
    bytes = bytes.subspan(length);
    at += length;
  }
  append_record(0, kEndOfFile, {}, out);
  return out;
}

}  // namespace palpate::bake
