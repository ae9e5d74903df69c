// SPDX-License-Identifier: Apache-2.0
#include "hal/usb/interfaces.hpp"

#include <span>

#include "hal/falcon/ftdi.hpp"
#include "hal/flash/dfu.hpp"
#include "hal/protocol/packets.hpp"

namespace palpate::hal::usb {
namespace {

bool is_class(const libusb_interface_descriptor& d, std::uint8_t device_class,
              std::uint8_t subclass, std::uint8_t protocol) {
  return d.bInterfaceClass == device_class && d.bInterfaceSubClass == subclass &&
         d.bInterfaceProtocol == protocol;
}

bool is_of_kind(Kind kind, const libusb_device_descriptor& device,
                const libusb_interface_descriptor& d) {
  switch (kind) {
    case Kind::falcon:
      return device.idVendor == falcon::kVendorId && device.idProduct == falcon::kProductId;
    case Kind::open_protocol:
      return is_class(d, protocol::kInterfaceClass, protocol::kInterfaceSubclass,
                      protocol::kInterfaceProtocol);
    case Kind::update:
      return is_class(d, flash::kDfuClass, flash::kDfuSubclass, flash::kDfuModeProtocol);
  }
  return false;
}

Interface interface_of(const libusb_interface_descriptor& d) {
  Interface out;
  out.number = d.bInterfaceNumber;
  for (const auto& endpoint : std::span(d.endpoint, d.bNumEndpoints)) {
    const auto type = static_cast<std::uint8_t>(endpoint.bmAttributes & 3);
    const bool usable = type == LIBUSB_TRANSFER_TYPE_BULK || type == LIBUSB_TRANSFER_TYPE_INTERRUPT;
    const bool is_in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
    if (!usable || (is_in ? out.in_address : out.out_address) != 0) continue;
    (is_in ? out.in_address : out.out_address) = endpoint.bEndpointAddress;
    (is_in ? out.in_type : out.out_type) = type;
    // The upper bits say how many packets a microframe takes.
    if (is_in) out.in_packet_bytes = endpoint.wMaxPacketSize & 0x7ff;
  }
  return out;
}

}  // namespace

std::optional<Interface> find_interface(Kind kind, libusb_device* device) {
  libusb_device_descriptor descriptor{};
  if (libusb_get_device_descriptor(device, &descriptor) != 0) return std::nullopt;
  const Config config = active_config(device);
  if (!config) return std::nullopt;
  for (const auto& interface : std::span(config->interface, config->bNumInterfaces)) {
    if (interface.num_altsetting < 1) continue;
    const libusb_interface_descriptor& d = interface.altsetting[0];
    if (!is_of_kind(kind, descriptor, d)) continue;
    const Interface found = interface_of(d);
    const bool has_both = found.in_address != 0 && found.out_address != 0;
    if (has_both || kind == Kind::update) return found;
  }
  return std::nullopt;
}

}  // namespace palpate::hal::usb
