// SPDX-License-Identifier: GPL-3.0-or-later
// --device KIND[:SERIAL], and USB devices made from it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "hal/device.hpp"
#include "hal/protocol/host_driver.hpp"
#include "hal/transport/transport.hpp"
#include "hal/usb/find.hpp"

namespace palpate::cli {

struct DeviceChoice {
  std::string kind;    ///< "mock", "mouse", "spacemouse", "usb", "falcon" or "tcp"
  std::string serial;  ///< empty: the only one there is; of tcp HOST[:PORT]
};

[[nodiscard]] DeviceChoice parse_device(const std::string& text);

/// For options: mock, mouse, spacemouse, usb[:SERIAL], falcon[:SERIAL] or tcp:HOST[:PORT].
[[nodiscard]] CLI::Validator is_device();

/// Throws Failure(kDevice) for what a device could not do. @param device  as the user named it
[[noreturn]] void fail(const std::string& device, const hal::DeviceProblem& problem);

/// The device's interface of a kind, opened. Throws Failure(kDevice).
[[nodiscard]] std::unique_ptr<hal::Transport> open_usb(const std::string& device,
                                                       hal::usb::Kind kind);

/// A device on USB, of this machine or by USB/IP, not yet open. Throws Failure: kDevice where there
/// is none, kRefused where the firmware file cannot be read.
/// @param firmware  the maker's file for a Falcon; empty: none  @param clock  must outlive it
/// @param images  of the scene, see hal::protocol::HostDriver
/// @param fifo_priority  of its I/O thread; 0: an ordinary thread
[[nodiscard]] std::unique_ptr<hal::Device> make_usb_device(
    const std::string& device, const std::filesystem::path& firmware,
    const std::vector<hal::protocol::ImageHash>& images, hal::Clock& clock, int fifo_priority);

}  // namespace palpate::cli
