// SPDX-License-Identifier: Apache-2.0
#include "hal/simulator/descriptors.hpp"

#include <algorithm>
#include <array>

#include "hal/falcon/ftdi.hpp"
#include "hal/flash/dfu.hpp"
#include "hal/flash/dfu_device.hpp"
#include "hal/protocol/packets.hpp"

namespace palpate::hal::simulator {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kProductString = 1;
constexpr std::uint8_t kSerialString = 2;
/// For tests of software (pid.codes): no product on sale has it.
constexpr std::uint16_t kTestVendor = 0x1209;
constexpr std::uint16_t kTestProduct = 0x0001;

/// bRequest of the standard requests that are known here.
enum Standard : std::uint8_t {
  kGetStatus = 0,
  kClearFeature = 1,
  kGetDescriptor = 6,
  kGetConfiguration = 8,
  kSetConfiguration = 9,
  kGetInterface = 10,
  kSetInterface = 11
};
enum DescriptorType : std::uint8_t { kDevice = 1, kConfiguration = 2, kString = 3 };

std::uint8_t low(std::size_t value) { return static_cast<std::uint8_t>(value & 0xff); }
std::uint8_t high(std::size_t value) { return static_cast<std::uint8_t>(value >> 8 & 0xff); }

Bytes device_descriptor(std::uint16_t vendor, std::uint16_t product, bool has_serial) {
  constexpr std::uint8_t kControlBytes = 64;
  const std::uint8_t serial = has_serial ? kSerialString : 0;
  return {kDeviceDescriptorBytes,
          kDevice,
          0x00,
          0x02,
          0,
          0,
          0,
          kControlBytes,
          low(vendor),
          high(vendor),
          low(product),
          high(product),
          0,
          1,
          0,
          kProductString,
          serial,
          1};
}

/// The configuration descriptor before its interfaces.
Bytes configuration_of(std::uint8_t interfaces, const Bytes& rest) {
  constexpr std::size_t kHeadBytes = 9;
  const std::size_t total = kHeadBytes + rest.size();
  Bytes all{kHeadBytes, kConfiguration, low(total), high(total), interfaces, 1, 0, 0x80, 50};
  all.resize(total);
  std::copy(rest.begin(), rest.end(), all.begin() + kHeadBytes);
  return all;
}

IoResult give(std::span<const std::uint8_t> bytes, std::span<std::byte> out) {
  const std::size_t length = std::min(bytes.size(), out.size());
  std::transform(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length), out.begin(),
                 [](std::uint8_t b) { return std::byte{b}; });
  return {IoStatus::ok, length};
}

/// UTF-16, as strings are on USB.
IoResult give_string(const std::string& text, std::span<std::byte> out) {
  Bytes bytes{low(2 + 2 * text.size()), kString};
  for (const char c : text) bytes.insert(bytes.end(), {static_cast<std::uint8_t>(c), 0});
  return give(bytes, out);
}

IoResult give_descriptor(const UsbDescriptors& d, std::uint16_t value, std::span<std::byte> out) {
  constexpr std::array<std::uint8_t, 4> kLanguages{4, kString, 0x09, 0x04};  // English (US)
  const std::uint8_t index = low(value);
  switch (high(value)) {
    case kDevice:
      return give(d.device, out);
    case kConfiguration:
      return index == 0 ? give(d.configuration, out) : IoResult{IoStatus::stalled};
    case kString:
      if (index == 0) return give(kLanguages, out);
      if (index == kProductString) return give_string(d.product, out);
      if (index == kSerialString && !d.serial.empty()) return give_string(d.serial, out);
      return {IoStatus::stalled};
    default:
      return {IoStatus::stalled};
  }
}

}  // namespace

UsbDescriptors open_device_descriptors(const std::string& serial, bool takes_images) {
  using namespace flash;
  constexpr std::uint16_t kTransfer = DfuDevice::kTransferBytes;
  Bytes interfaces{// clang-format off
      9, 4, 0, 0, 2, protocol::kInterfaceClass, protocol::kInterfaceSubclass, protocol::kInterfaceProtocol, 0,
      7, 5, 0x81, 3, 64, 0, 2,
      7, 5, 0x01, 3, 64, 0, 2};
  const Bytes update{
      9, 4, 1, 0, 0, kDfuClass, kDfuSubclass, kDfuModeProtocol, 0,
      9, 4, 1, 1, 0, kDfuClass, kDfuSubclass, kDfuModeProtocol, 0,
      9, kFunctionalDescriptorType, kCanDownload | kCanUpload | kManifestationTolerant, 0, 0,
      low(kTransfer), high(kTransfer), 0x10, 1};
  // clang-format on
  if (takes_images) interfaces.insert(interfaces.end(), update.begin(), update.end());
  UsbDescriptors out;
  out.device = device_descriptor(kTestVendor, kTestProduct, !serial.empty());
  out.configuration = configuration_of(takes_images ? 2 : 1, interfaces);
  out.product = "Palpate simulated device";
  out.serial = serial;
  return out;
}

UsbDescriptors falcon_descriptors(const std::string& serial) {
  UsbDescriptors out;
  out.device = device_descriptor(falcon::kVendorId, falcon::kProductId, !serial.empty());
  // clang-format off
  out.configuration = configuration_of(1, {9, 4, 0, 0, 2, 0xff, 0xff, 0xff, 0,
                                           7, 5, 0x81, 2, 64, 0, 0,
                                           7, 5, 0x02, 2, 64, 0, 0});
  // clang-format on
  out.product = "Falcon, simulated";
  out.serial = serial;
  out.speed = UsbSpeed::full;
  return out;
}

IoResult standard_in(const UsbDescriptors& descriptors, const ControlRequest& request,
                     std::span<std::byte> out) {
  constexpr std::array<std::uint8_t, 2> kNothing{0, 0};
  constexpr std::array<std::uint8_t, 1> kFirst{1};
  switch (request.request) {
    case kGetDescriptor:
      return give_descriptor(descriptors, request.value, out);
    case kGetConfiguration:
      return give(kFirst, out);
    case kGetInterface:
      return give(std::span(kNothing).first(1), out);
    case kGetStatus:
      return give(kNothing, out);
    default:
      return {IoStatus::stalled};
  }
}

IoResult standard_out(const ControlRequest& request) {
  const bool known = (request.request == kSetConfiguration && request.value <= 1) ||
                     (request.request == kSetInterface && request.value == 0) ||
                     request.request == kClearFeature;
  return {known ? IoStatus::ok : IoStatus::stalled};
}

}  // namespace palpate::hal::simulator
