// SPDX-License-Identifier: Apache-2.0
// libusb's objects with owners. Only files of this folder know libusb.
#pragma once

#include <libusb-1.0/libusb.h>

#include <memory>
#include <string>

namespace palpate::hal::usb {

/// Shared by what is open; ends with the last of them.
using Context = std::shared_ptr<libusb_context>;

struct HandleDeleter {
  void operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }
};
using Handle = std::unique_ptr<libusb_device_handle, HandleDeleter>;

struct ConfigDeleter {
  void operator()(libusb_config_descriptor* config) const noexcept {
    libusb_free_config_descriptor(config);
  }
};
using Config = std::unique_ptr<libusb_config_descriptor, ConfigDeleter>;

/// Null where libusb cannot be used.
[[nodiscard]] Context make_context() noexcept;

/// The device's present configuration; null where it has none.
[[nodiscard]] Config active_config(libusb_device* device) noexcept;

/// A string of the device, in ASCII; empty where there is none.
[[nodiscard]] std::string read_string(libusb_device_handle* handle, std::uint8_t index);

/// "2-1.4": bus and the ports on the way, as in /sys/bus/usb/devices.
[[nodiscard]] std::string port_path(libusb_device* device);

/// The devices of the bus, for as long as this lives.
class DeviceList {
 public:
  explicit DeviceList(libusb_context* context) noexcept;
  ~DeviceList();
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;
  DeviceList(DeviceList&&) = delete;
  DeviceList& operator=(DeviceList&&) = delete;

  [[nodiscard]] libusb_device** begin() const noexcept { return list_; }
  [[nodiscard]] libusb_device** end() const noexcept { return list_ + count_; }

 private:
  libusb_device** list_ = nullptr;
  std::ptrdiff_t count_ = 0;
};

}  // namespace palpate::hal::usb
