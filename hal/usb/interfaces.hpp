// SPDX-License-Identifier: Apache-2.0
// Which interface of a USB device is the one that a driver wants.
#pragma once

#include <optional>

#include "hal/usb/find.hpp"
#include "hal/usb/usb_session.hpp"

namespace palpate::hal::usb {

/// An interface with its endpoints.
struct Interface {
  std::uint8_t number = 0;
  std::uint8_t in_address = 0;   ///< 0: it has none
  std::uint8_t out_address = 0;  ///< 0: it has none
  std::uint8_t in_type = 0;      ///< LIBUSB_TRANSFER_TYPE_BULK or INTERRUPT
  std::uint8_t out_type = 0;
  std::uint16_t in_packet_bytes = 64;
};

/// The first interface of a kind in the device's present configuration, with its first endpoints of
/// each direction; absent where the device has none, or one for the exchange without endpoints.
[[nodiscard]] std::optional<Interface> find_interface(Kind kind, libusb_device* device);

}  // namespace palpate::hal::usb
