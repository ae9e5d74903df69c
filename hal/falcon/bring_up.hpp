// SPDX-License-Identifier: Apache-2.0
// From a Falcon that has been plugged in to one that answers: line set-up, and where it holds no
// firmware, the upload of a file that the user supplies. None is shipped with this project.
//
//   probe --answers--> running
//     | silent
//   enter loader -> hello -> start upload -> upload -> run -> probe --answers--> running
//     ^------------------- any failure, kMaxAttempts times ---------'
//
// Source: the sequence that the libnifalcon project uses. Departures: the latency timer is read
// back; replies may be split or merged in any way; every failure says its phase and reason.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "hal/device.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal::falcon {

enum class Phase { probe, enter_loader, hello, start_upload, upload, run };

/// "probe", "enter loader" and so on. Static storage.
[[nodiscard]] std::string_view name(Phase phase) noexcept;

inline constexpr int kMaxAttempts = 3;  ///< at the upload
inline constexpr int kMaxHellos = 100;  ///< of one attempt
inline constexpr int kProbes = 10;      ///< requests until a reply is given up
inline constexpr std::size_t kMinFirmwareBytes = 1024;
inline constexpr std::size_t kMaxFirmwareBytes = 64 * 1024;

/// Leaves the device answering requests, with its motors off. Blocks: up to a second where firmware
/// runs, two for an upload, a minute until it gives up. @param firmware  the file's bytes; empty
/// where the user gave none
[[nodiscard]] std::optional<DeviceProblem> bring_up(Transport& transport,
                                                    std::span<const std::byte> firmware);

}  // namespace palpate::hal::falcon
