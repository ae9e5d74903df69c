// SPDX-License-Identifier: Apache-2.0
#include "hal/usb/find.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "hal/protocol/host_driver.hpp"
#include "hal/text_table.hpp"
#include "hal/usb/interfaces.hpp"
#include "hal/usb/libusb_transport.hpp"

namespace palpate::hal::usb {
namespace {

constexpr const char* kRuleFix =
    "'sudo tools/setup/host' installs the udev rule; then plug it in again";

struct Candidate {
  libusb_device* device = nullptr;
  std::uint8_t serial_index = 0;
  Interface interface;
};

std::optional<Candidate> candidate_of(Kind kind, libusb_device* device) {
  libusb_device_descriptor descriptor{};
  if (libusb_get_device_descriptor(device, &descriptor) != 0) return std::nullopt;
  const auto interface = find_interface(kind, device);
  if (!interface) return std::nullopt;
  return Candidate{device, descriptor.iSerialNumber, *interface};
}

DeviceProblem problem_of(int error) {
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      return {"open", "no permission to use the device", kRuleFix};
    case LIBUSB_ERROR_BUSY:
      return {"claim", "another program uses the device", "end that program"};
    case LIBUSB_ERROR_NO_DEVICE:
      return {"open", "the device is gone", "plug it in again"};
    default:
      return {"open", libusb_error_name(error), "plug the device in again"};
  }
}

std::string joined(const std::set<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// An open device with its interface claimed.
struct Claimed {
  Handle handle;
  std::string serial;
  std::optional<DeviceProblem> problem;
};

struct Opened {
  Claimed claimed;
  Interface interface;
};

Claimed claim(const Candidate& candidate) {
  Claimed out;
  libusb_device_handle* handle = nullptr;
  int error = libusb_open(candidate.device, &handle);
  if (error == 0) {
    out.handle.reset(handle);
    out.serial = read_string(handle, candidate.serial_index);
    libusb_set_auto_detach_kernel_driver(handle, 1);
    error = libusb_claim_interface(handle, candidate.interface.number);
  }
  if (error != 0) out.problem = problem_of(error);
  return out;
}

/// What a device says about itself must make sense too.
std::optional<DeviceProblem> ask(Kind kind, const Context& context, Claimed claimed,
                                 const Interface& interface) {
  LibusbTransport transport(context, std::move(claimed.handle), interface);
  if (kind != Kind::open_protocol) return std::nullopt;
  protocol::Capabilities capabilities;
  return protocol::read_descriptor(transport, protocol::PacketType::capabilities, 0, capabilities);
}

FoundDevice describe(Kind kind, const Context& context, const Candidate& candidate) {
  Claimed claimed = claim(candidate);
  FoundDevice found;
  found.kind = kind;
  found.serial = claimed.serial;
  found.path = port_path(candidate.device);
  const auto problem = claimed.problem
                           ? claimed.problem
                           : ask(kind, context, std::move(claimed), candidate.interface);
  found.ready = !problem;
  if (problem) {
    found.problem = problem->phase + ": " + problem->cause;
    found.fix = problem->fix;
  }
  return found;
}

}  // namespace

std::string_view name(Kind kind) noexcept {
  return text_in<Kind>(
      {{Kind::open_protocol, "usb"}, {Kind::falcon, "falcon"}, {Kind::update, "update"}}, kind,
      "unknown");
}

std::vector<FoundDevice> find_devices() {
  std::vector<FoundDevice> found;
  const Context context = make_context();
  if (!context) return found;
  for (libusb_device* device : DeviceList(context.get())) {
    for (const Kind kind : {Kind::open_protocol, Kind::falcon}) {
      if (const auto c = candidate_of(kind, device)) found.push_back(describe(kind, context, *c));
    }
  }
  // The bus lists them in any order.
  std::sort(found.begin(), found.end(),
            [](const FoundDevice& a, const FoundDevice& b) { return a.path < b.path; });
  return found;
}

std::variant<std::unique_ptr<Transport>, DeviceProblem> open_transport(Kind kind,
                                                                       const std::string& serial) {
  Context context = make_context();
  if (!context) return DeviceProblem{"USB", "libusb cannot be used on this host", "see 'lsusb'"};
  const DeviceList list(context.get());
  std::vector<Opened> meant;
  std::optional<DeviceProblem> unopened;
  std::set<std::string> serials;
  for (libusb_device* device : list) {
    const auto candidate = candidate_of(kind, device);
    if (!candidate) continue;
    Claimed claimed = claim(*candidate);
    if (!claimed.serial.empty()) serials.insert(claimed.serial);
    if (serial.empty() || claimed.serial == serial) {
      meant.push_back({std::move(claimed), candidate->interface});
    } else if (!claimed.handle) {
      // One that cannot be opened cannot say its serial number: it may be the one that is meant.
      unopened = claimed.problem;
    }
  }
  if (meant.size() > 1) {
    return DeviceProblem{"find", "more than one such device is connected",
                         "name one by its serial number: " + joined(serials)};
  }
  if (meant.empty() && unopened) return *unopened;
  if (meant.empty() && !serials.empty()) {
    return DeviceProblem{"find", "no device with this serial number is connected",
                         "connected are: " + joined(serials)};
  }
  if (meant.empty()) {
    return DeviceProblem{"find", "no such device is connected",
                         "plug it in and switch it on; 'palpate devices' lists what is there"};
  }
  Opened& chosen = meant.front();
  if (chosen.claimed.problem) return *chosen.claimed.problem;
  return std::make_unique<LibusbTransport>(std::move(context), std::move(chosen.claimed.handle),
                                           chosen.interface);
}

}  // namespace palpate::hal::usb
