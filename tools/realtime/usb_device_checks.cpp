// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/usb_device_checks.hpp"

#include <algorithm>
#include <string>

#include "tools/realtime/host_files.hpp"

namespace palpate::realtime {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRule = "udev/rules.d/70-palpate.rules";
constexpr const char* kDevices = "sys/bus/usb/devices";

/// Of "70-palpate.rules": the open protocol, by an interface, and the Falcon.
bool is_haptic(const fs::path& device) {
  const auto is = [](const fs::path& file, const char* text) { return first_line(file) == text; };
  if (is(device / "idVendor", "0403") && is(device / "idProduct", "cb48")) return true;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(device, unreadable)) {
    const fs::path& interface = entry.path();
    if (is(interface / "bInterfaceClass", "ff") && is(interface / "bInterfaceSubClass", "50") &&
        is(interface / "bInterfaceProtocol", "41")) {
      return true;
    }
  }
  return false;
}

/// Why a device may be put to sleep; empty where it is not.
std::string sleep_of(const fs::path& device) {
  const std::string control = first_line(device / "power/control").value_or("");
  const std::string delay_s = first_line(device / "power/autosuspend").value_or("");
  if (control == "on" || delay_s.rfind('-', 0) == 0) return "";
  return device.filename().string() + " after " + (delay_s.empty() ? "?" : delay_s) +
         " s (power/control is " + (control.empty() ? "unknown" : control) + ")";
}

HostCheck usb_autosuspend(const fs::path& root, const std::string& set_up) {
  const auto check = [&](bool ok, const std::string& found) {
    return make_check("usb_autosuspend", ok, found,
                      "off for haptic devices: one that sleeps wakes up too late",
                      set_up + ", then plug the device in again");
  };
  std::string awake, asleep;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(root / "sys/bus/usb/devices", unreadable)) {
    if (!is_haptic(entry.path())) continue;
    const std::string sleep = sleep_of(entry.path());
    if (sleep.empty()) {
      append(awake, ", ", entry.path().filename().string());
    } else {
      append(asleep, ", ", sleep);
    }
  }
  if (!asleep.empty()) return check(false, asleep);
  if (!awake.empty()) return check(true, "off for " + awake);
  const auto found = first_line(root / "sys/module/usbcore/parameters/autosuspend");
  if (!found) return check(true, "USB is not loaded");
  if (*found != "-1" && udev_rule_installed(root)) {
    return check(true, *found + " s, and off for haptic devices by the udev rule");
  }
  return check(*found == "-1", *found + " s");
}

/// The port of the root hub that a device is below, "2-1" of "2-1.4"; empty where it is plugged in
/// there itself.
std::string hub_of(const std::string& device) {
  const std::size_t dot = device.find('.');
  return dot == std::string::npos ? "" : device.substr(0, dot);
}

/// Devices other than this one below a hub, hubs left out.
std::string others_below(const fs::path& root, const std::string& hub, const std::string& device) {
  std::string others;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(root / kDevices, unreadable)) {
    const std::string name = entry.path().filename().string();
    const bool is_interface = name.find(':') != std::string::npos;
    const bool is_hub = first_line(entry.path() / "bDeviceClass") == "09";
    if (hub_of(name) == hub && name != device && !is_interface && !is_hub) {
      append(others, ", ", name);
    }
  }
  return others;
}

HostCheck usb_port(const fs::path& root) {
  std::string found, shared;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(root / kDevices, unreadable)) {
    if (!is_haptic(entry.path())) continue;
    const std::string name = entry.path().filename().string();
    const std::string hub = hub_of(name);
    append(found, ", ", name);
    const std::string others = hub.empty() ? "" : others_below(root, hub, name);
    if (others.empty()) continue;
    append(shared, "; ", name);
    shared += " shares the hub ";
    shared += hub;
    shared += " with ";
    shared += others;
  }
  return make_check("usb_port", shared.empty(),
                    !shared.empty()  ? shared
                    : !found.empty() ? "of its own for " + found
                                     : "no haptic device is plugged in",
                    "no hub that other devices use too: they take turns there",
                    "plug the haptic device into another port, or the others");
}

/// Links of PCI Express to USB controllers take microseconds to wake up.
HostCheck usb_bus_power(const fs::path& root) {
  constexpr const char* kUsbController = "0x0c03";
  std::string found, fix;
  std::error_code unreadable;
  for (const auto& device : fs::directory_iterator(root / "sys/bus/pci/devices", unreadable)) {
    if (first_line(device.path() / "class").value_or("").rfind(kUsbController, 0) != 0) continue;
    for (const auto& state : fs::directory_iterator(device.path() / "link", unreadable)) {
      if (first_line(state.path()) != "1") continue;
      append(found, ", ",
             device.path().filename().string() + " by " + state.path().filename().string());
      append(fix, " && ",
             "echo 0 | sudo tee " + ("/" / state.path().lexically_relative(root)).string());
    }
  }
  return make_check(
      "usb_bus_power", found.empty(),
      found.empty() ? "no link to a USB controller may sleep" : "links that may sleep: " + found,
      "no power management of the link to the USB controller",
      fix +
          " (until the next start; for good in the firmware's set-up, or by the "
          "kernel parameter pcie_aspm=off)");
}

}  // namespace

bool udev_rule_installed(const fs::path& root) {
  return fs::exists(root / "etc" / kRule) || fs::exists(root / "usr/lib" / kRule);
}

std::vector<HostCheck> usb_device_checks(const fs::path& root, const std::string& set_up) {
  return {usb_autosuspend(root, set_up), usb_port(root), usb_bus_power(root)};
}

}  // namespace palpate::realtime
