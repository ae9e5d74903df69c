// SPDX-License-Identifier: Apache-2.0
#include "hal/flash/dfu_suffix.hpp"

#include "hal/protocol/bytes.hpp"
#include "hal/protocol/crc32.hpp"

namespace palpate::hal::flash {
namespace {

// Offsets within the suffix.
constexpr std::size_t kDeviceAt = 0;
constexpr std::size_t kProductAt = 2;
constexpr std::size_t kVendorAt = 4;
constexpr std::size_t kVersionAt = 6;
constexpr std::size_t kSignatureAt = 8;
constexpr std::size_t kLengthAt = 11;
constexpr std::size_t kCrcAt = 12;

constexpr std::uint16_t kDfuVersion = 0x0100;
constexpr std::array<std::uint8_t, 3> kSignature{'U', 'F', 'D'};

}  // namespace

std::array<std::byte, kSuffixBytes> make_suffix(std::span<const std::byte> contents,
                                                const DfuSuffix& suffix) noexcept {
  std::array<std::byte, kSuffixBytes> out{};
  const std::span<std::byte> bytes(out);
  put(bytes, kDeviceAt, suffix.device_version);
  put(bytes, kProductAt, suffix.product);
  put(bytes, kVendorAt, suffix.vendor);
  put(bytes, kVersionAt, kDfuVersion);
  for (std::size_t i = 0; i < kSignature.size(); ++i) put(bytes, kSignatureAt + i, kSignature[i]);
  put(bytes, kLengthAt, static_cast<std::uint8_t>(kSuffixBytes));
  // The state itself, not its complement.
  const std::uint32_t state = crc32_update(kCrc32Start, contents);
  put(bytes, kCrcAt, crc32_update(state, bytes.first(kCrcAt)));
  return out;
}

std::optional<DfuSuffix> read_suffix(std::span<const std::byte> file) noexcept {
  if (file.size() < kSuffixBytes) return std::nullopt;
  const auto bytes = file.last(kSuffixBytes);
  DfuSuffix suffix;
  suffix.device_version = get<std::uint16_t>(bytes, kDeviceAt);
  suffix.product = get<std::uint16_t>(bytes, kProductAt);
  suffix.vendor = get<std::uint16_t>(bytes, kVendorAt);
  const auto right = make_suffix(file.first(file.size() - kSuffixBytes), suffix);
  for (std::size_t i = 0; i < kSuffixBytes; ++i) {
    if (bytes[i] != right[i]) return std::nullopt;
  }
  return suffix;
}

}  // namespace palpate::hal::flash
