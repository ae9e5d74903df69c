// SPDX-License-Identifier: Apache-2.0
// The USB/IP client in this machine's kernel, vhci_hcd, by its files in sysfs
// (Documentation/ABI/testing/sysfs-platform-vhci_hcd of Linux): what `usbip attach` does once, for
// a device that comes back by itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hal/simulator/descriptors.hpp"

namespace palpate::hal::usbip {

class Vhci {
 public:
  explicit Vhci(std::filesystem::path folder = "/sys/devices/platform/vhci_hcd.0")
      : folder_(std::move(folder)) {}

  /// Whether one of its ports has a device with the numbers of Server's.
  [[nodiscard]] bool has_device() const;

  /// Plugs Server's device into a free port. False where none is free, or this user may not.
  /// @param fd  one end of a socket; the kernel keeps it, whatever becomes of this descriptor
  [[nodiscard]] bool attach(int fd, simulator::UsbSpeed speed) const;

 private:
  [[nodiscard]] std::optional<unsigned> free_port() const;

  std::filesystem::path folder_;
};

}  // namespace palpate::hal::usbip
