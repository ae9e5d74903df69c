// SPDX-License-Identifier: Apache-2.0
#include "hal/usbip/messages.hpp"

#include <algorithm>
#include <string>

#include "hal/protocol/bytes.hpp"

namespace palpate::hal::usbip {
namespace {

constexpr std::uint32_t kMaxEndpoint = 15;

// Offsets in a transfer header.
constexpr std::size_t kCommandAt = 0;
constexpr std::size_t kSequenceAt = 4;
constexpr std::size_t kDeviceAt = 8;
constexpr std::size_t kDirectionAt = 12;
constexpr std::size_t kEndpointAt = 16;
constexpr std::size_t kVictimAt = 20;  // unlink
constexpr std::size_t kStatusAt = 20;  // replies
constexpr std::size_t kLengthAt = 24;
constexpr std::size_t kPacketsAt = 32;
constexpr std::size_t kSetupAt = 40;
constexpr std::uint32_t kNoPackets = 0xffffffff;  // not isochronous

// Offsets in the record of a device.
constexpr std::size_t kPathBytes = 256;
constexpr std::size_t kNumbersAt = kPathBytes + kBusIdBytes;
constexpr std::size_t kSpeedAt = kNumbersAt + 8;
constexpr std::size_t kIdsAt = kSpeedAt + 4;
constexpr std::size_t kClassAt = kIdsAt + 6;
constexpr std::size_t kConfigurationAt = kClassAt + 3;

// Offsets in USB's own descriptors.
constexpr std::size_t kUsbClassAt = 4;
constexpr std::size_t kUsbIdsAt = 8;
constexpr std::size_t kInterfacesAt = 4;
constexpr std::size_t kConfigurationValueAt = 5;
constexpr std::uint8_t kInterfaceDescriptor = 4;
constexpr std::uint8_t kEndpointDescriptor = 5;

/// Big-endian, as everything here.
template <class T>
void put_be(std::span<std::byte> bytes, std::size_t at, T value) noexcept {
  std::array<std::byte, sizeof(T)> little{};
  put(std::span<std::byte>(little), 0, value);
  std::reverse_copy(little.begin(), little.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

template <class T>
[[nodiscard]] T get_be(std::span<const std::byte> bytes, std::size_t at) noexcept {
  std::array<std::byte, sizeof(T)> little{};
  std::reverse_copy(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at + sizeof(T)), little.begin());
  return get<T>(std::span<const std::byte>(little), 0);
}

/// Calls a function with each descriptor of a configuration until it returns true.
template <class Function>
bool any_descriptor(const std::vector<std::uint8_t>& configuration, Function function) {
  const std::span<const std::uint8_t> all(configuration);
  for (std::size_t at = 0; at + 2 <= all.size() && all[at] >= 2 && at + all[at] <= all.size();
       at += all[at]) {
    if (function(all.subspan(at, all[at]))) return true;
  }
  return false;
}

void put_text(std::span<std::byte> bytes, std::size_t at, std::string_view text) {
  std::transform(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 [](char c) { return static_cast<std::byte>(c); });
}

}  // namespace

std::array<std::byte, kOperationBytes> encode(const Operation& operation) noexcept {
  std::array<std::byte, kOperationBytes> bytes{};
  put_be(bytes, 0, operation.version);
  put_be(bytes, 2, static_cast<std::uint16_t>(operation.code));
  put_be(bytes, 4, operation.status);
  return bytes;
}

Operation decode_operation(std::span<const std::byte, kOperationBytes> bytes) noexcept {
  return {get_be<std::uint16_t>(bytes, 0), Code{get_be<std::uint16_t>(bytes, 2)},
          get_be<std::uint32_t>(bytes, 4)};
}

std::array<std::byte, kTransferHeaderBytes> encode(const TransferHeader& h) noexcept {
  std::array<std::byte, kTransferHeaderBytes> bytes{};
  put_be(bytes, kCommandAt, static_cast<std::uint32_t>(h.command));
  put_be(bytes, kSequenceAt, h.sequence);
  put_be(bytes, kDeviceAt, h.device);
  put_be(bytes, kDirectionAt, std::uint32_t{h.is_in});
  put_be(bytes, kEndpointAt, h.endpoint);
  if (h.command == Command::unlink) {
    put_be(bytes, kVictimAt, h.victim);
    return bytes;
  }
  put_be(bytes, kStatusAt, h.status);
  if (h.command == Command::unlink_reply) return bytes;
  put_be(bytes, kLengthAt, h.length);
  put_be(bytes, kPacketsAt, kNoPackets);
  std::copy(h.setup.begin(), h.setup.end(), bytes.begin() + kSetupAt);
  return bytes;
}

bool decode(std::span<const std::byte, kTransferHeaderBytes> bytes, TransferHeader& out) noexcept {
  TransferHeader h;
  const auto command = get_be<std::uint32_t>(bytes, kCommandAt);
  const auto direction = get_be<std::uint32_t>(bytes, kDirectionAt);
  h.endpoint = get_be<std::uint32_t>(bytes, kEndpointAt);
  if (command < static_cast<std::uint32_t>(Command::submit) ||
      command > static_cast<std::uint32_t>(Command::unlink_reply) || direction > 1 ||
      h.endpoint > kMaxEndpoint) {
    return false;
  }
  h.command = Command{command};
  h.sequence = get_be<std::uint32_t>(bytes, kSequenceAt);
  h.device = get_be<std::uint32_t>(bytes, kDeviceAt);
  h.is_in = direction == 1;
  if (h.command == Command::unlink) {
    h.victim = get_be<std::uint32_t>(bytes, kVictimAt);
  } else if (h.command != Command::submit) {
    h.status = get_be<std::int32_t>(bytes, kStatusAt);
  }
  if (h.command == Command::submit || h.command == Command::submit_reply) {
    if (get_be<std::int32_t>(bytes, kLengthAt) < 0) return false;
    h.length = get_be<std::uint32_t>(bytes, kLengthAt);
    std::copy_n(bytes.begin() + kSetupAt, h.setup.size(), h.setup.begin());
  }
  out = h;
  return true;
}

std::vector<std::byte> describe(const simulator::UsbDescriptors& d, bool with_interfaces) {
  std::vector<std::byte> out(kDeviceBytes);
  put_text(out, 0, std::string("/sys/devices/palpate-sim/usb1/") + std::string(kBusId));
  put_text(out, kPathBytes, kBusId);
  put_be(out, kNumbersAt, kBusNumber);
  put_be(out, kNumbersAt + 4, kDeviceNumber);
  put_be(out, kSpeedAt, static_cast<std::uint32_t>(d.speed));
  const auto byte = [](std::uint8_t b) { return std::byte{b}; };
  for (std::size_t field = 0; field < 3;
       ++field) {  // vendor, product, version: little-endian there
    out[kIdsAt + 2 * field] = byte(d.device[kUsbIdsAt + 2 * field + 1]);
    out[kIdsAt + 2 * field + 1] = byte(d.device[kUsbIdsAt + 2 * field]);
  }
  for (std::size_t i = 0; i < 3; ++i) out[kClassAt + i] = byte(d.device[kUsbClassAt + i]);
  out[kConfigurationAt] = byte(d.configuration[kConfigurationValueAt]);
  out[kConfigurationAt + 1] = byte(d.device[simulator::kDeviceDescriptorBytes - 1]);
  out[kConfigurationAt + 2] = byte(d.configuration[kInterfacesAt]);
  if (!with_interfaces) return out;
  any_descriptor(d.configuration, [&](std::span<const std::uint8_t> one) {
    const bool is_first_setting = one[1] == kInterfaceDescriptor && one[3] == 0;
    if (is_first_setting) out.insert(out.end(), {byte(one[5]), byte(one[6]), byte(one[7]), {}});
    return false;
  });
  return out;
}

bool has_endpoint(const simulator::UsbDescriptors& d, std::uint8_t address) noexcept {
  return any_descriptor(d.configuration, [&](std::span<const std::uint8_t> one) {
    return one[1] == kEndpointDescriptor && one[2] == address;
  });
}

Setup decode_setup(const std::array<std::byte, 8>& bytes) noexcept {
  // USB's own words, and so little-endian.
  const std::span<const std::byte> b(bytes);
  return {{get<std::uint8_t>(b, 0), get<std::uint8_t>(b, 1), get<std::uint16_t>(b, 2),
           get<std::uint16_t>(b, 4)},
          get<std::uint16_t>(b, 6)};
}

std::array<std::byte, 8> encode_setup(const Setup& setup) noexcept {
  std::array<std::byte, 8> bytes{};
  const std::span<std::byte> b(bytes);
  put(b, 0, setup.request.type);
  put(b, 1, setup.request.request);
  put(b, 2, setup.request.value);
  put(b, 4, setup.request.index);
  put(b, 6, setup.length);
  return bytes;
}

}  // namespace palpate::hal::usbip
