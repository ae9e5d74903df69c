// SPDX-License-Identifier: Apache-2.0
#include "hal/usb/usb_session.hpp"

#include <algorithm>
#include <array>

namespace palpate::hal::usb {

Context make_context() noexcept {
  libusb_context* context = nullptr;
  if (libusb_init(&context) != 0) return nullptr;
  return Context(context, [](libusb_context* c) { libusb_exit(c); });
}

Config active_config(libusb_device* device) noexcept {
  libusb_config_descriptor* config = nullptr;
  return libusb_get_active_config_descriptor(device, &config) == 0 ? Config(config) : nullptr;
}

std::string read_string(libusb_device_handle* handle, std::uint8_t index) {
  if (index == 0) return "";
  std::array<unsigned char, 128> text{};
  const int length =
      libusb_get_string_descriptor_ascii(handle, index, text.data(), static_cast<int>(text.size()));
  return length > 0 ? std::string(text.begin(), text.begin() + length) : "";
}

std::string port_path(libusb_device* device) {
  // USB allows seven tiers.
  std::array<std::uint8_t, 7> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string path = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i) {
    path += (i == 0 ? '-' : '.') + std::to_string(ports[static_cast<std::size_t>(i)]);
  }
  return path;
}

DeviceList::DeviceList(libusb_context* context) noexcept {
  count_ = std::max<std::ptrdiff_t>(0, libusb_get_device_list(context, &list_));
}

DeviceList::~DeviceList() {
  if (list_ != nullptr) libusb_free_device_list(list_, 1);
}

}  // namespace palpate::hal::usb
