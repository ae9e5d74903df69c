// SPDX-License-Identifier: Apache-2.0
// An update of a device's image, from the host: which slot, written, read back, and only then the
// restart that switches to it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "hal/flash/dfu_host.hpp"
#include "hal/protocol/packets.hpp"

namespace palpate::hal::flash {

/// What an update needs to know of a device.
struct UpdateTarget {
  protocol::Capabilities capabilities;
  protocol::ImageIdentity image;
};

/// @param exchange  the device's interface of the open protocol
[[nodiscard]] std::optional<DeviceProblem> read_target(Transport& exchange, UpdateTarget& out);

/// The slot to write: the wanted one, else one that is not in use. The problem where the device
/// takes no images, or not this one, or the slot is in use. @param image_bytes  size of the image
[[nodiscard]] std::variant<std::uint8_t, DeviceProblem> choose_slot(
    const UpdateTarget& target, std::size_t image_bytes, std::optional<std::uint8_t> wanted);

/// What is going on, for people, and how far it is.
using StageProgress = std::function<void(const char* stage, double share)>;

/// Writes an image to a slot and compares what the device then holds with it, byte for byte. Where
/// they differ the slot is spoilt again, so that the device cannot switch to it.
/// @param update  the device's DFU interface  @param image  validated
[[nodiscard]] std::optional<DeviceProblem> write_slot(Transport& update, Clock& clock,
                                                      std::uint8_t slot,
                                                      std::span<const std::byte> image,
                                                      const StageProgress& progress);

/// Makes the device start anew, with its newest image; it leaves the bus meanwhile.
[[nodiscard]] std::optional<DeviceProblem> restart(Transport& exchange);

}  // namespace palpate::hal::flash
