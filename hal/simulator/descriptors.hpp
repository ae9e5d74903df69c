// SPDX-License-Identifier: Apache-2.0
// What a simulated device says about itself on USB, and the standard requests that ask for it (USB
// 2.0, chapter 9): the same whichever front end the device stands behind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/transport/transport.hpp"

namespace palpate::hal::simulator {

inline constexpr std::size_t kDeviceDescriptorBytes = 18;

/// As Linux numbers them.
enum class UsbSpeed : std::uint8_t { full = 2, high = 3 };

struct UsbDescriptors {
  std::vector<std::uint8_t> device;         ///< kDeviceDescriptorBytes
  std::vector<std::uint8_t> configuration;  ///< with its interfaces and endpoints
  std::string product;                      ///< ASCII
  std::string serial;                       ///< ASCII; empty: it has none
  UsbSpeed speed = UsbSpeed::high;
};

/// A device of the open protocol: interface 0 for the exchange, interrupt endpoints 0x81 and 0x01;
/// where it takes images, interface 1 for updates with an alternate setting for each slot.
[[nodiscard]] UsbDescriptors open_device_descriptors(const std::string& serial, bool takes_images);

/// A Falcon: interface 0 with the bulk endpoints 0x81 and 0x02, full speed.
[[nodiscard]] UsbDescriptors falcon_descriptors(const std::string& serial);

/// True for requests that standard_in() and standard_out() answer.
[[nodiscard]] constexpr bool is_standard(const ControlRequest& request) noexcept {
  return (request.type & 0x60) == 0;
}

/// Descriptors, configuration 1, alternate setting 0, status 0; stalls for anything else.
[[nodiscard]] IoResult standard_in(const UsbDescriptors& descriptors, const ControlRequest& request,
                                   std::span<std::byte> out);

/// Takes configurations 0 and 1, alternate setting 0 and the end of a halt; stalls for anything
/// else.
[[nodiscard]] IoResult standard_out(const ControlRequest& request);

}  // namespace palpate::hal::simulator
