// SPDX-License-Identifier: Apache-2.0
// Haptic devices on the USB of this host: which there are, whether they can be used, and opened.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hal/device.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal::usb {

enum class Kind {
  open_protocol,  ///< docs/PROTOCOL.md, the interface for the exchange
  falcon,
  update  ///< the DFU interface of a device of the open protocol
};

/// "usb", "falcon", "update".
[[nodiscard]] std::string_view name(Kind kind) noexcept;

struct FoundDevice {
  Kind kind = Kind::open_protocol;
  std::string serial;  ///< empty where it has none or cannot be asked
  std::string path;    ///< "2-1.4", as in /sys/bus/usb/devices
  bool ready = false;
  std::string problem;  ///< "phase: likely cause"; empty where ready
  std::string fix;      ///< likewise
};

/// Every device with an interface for the exchange, by path. Opens and closes each. May block.
[[nodiscard]] std::vector<FoundDevice> find_devices();

/// Opens the device's interface of a kind. The problem where there is none, more than one, or it
/// cannot be used. @param serial  empty: the only one there is
[[nodiscard]] std::variant<std::unique_ptr<Transport>, DeviceProblem> open_transport(
    Kind kind, const std::string& serial);

}  // namespace palpate::hal::usb
