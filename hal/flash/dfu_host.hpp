// SPDX-License-Identifier: Apache-2.0
// The host's side of USB DFU 1.1: a download with its manifestation, and an upload, over any
// transport.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.hpp"
#include "hal/device.hpp"
#include "hal/transport/transport.hpp"

namespace palpate::hal::flash {

/// What the DFU interface says that it can do.
struct DfuFunctions {
  std::uint8_t attributes = 0;  ///< DfuAttribute
  std::uint16_t transfer_bytes = 0;
};

/// Told how much is done, in [0, 1].
using Progress = std::function<void(double)>;

/// All block and return the problem where they cannot; its cause says the block and the device's
/// status.
[[nodiscard]] std::optional<DeviceProblem> read_functions(Transport& transport, DfuFunctions& out);

/// Sends all bytes to the alternate setting that is selected and waits for the manifestation. The
/// device must stay in reach (manifestation tolerant).
[[nodiscard]] std::optional<DeviceProblem> download(Transport& transport,
                                                    const DfuFunctions& functions, Clock& clock,
                                                    std::span<const std::byte> bytes,
                                                    const Progress& progress);

/// Reads until the device has no more. More than `max_bytes` is a problem.
[[nodiscard]] std::optional<DeviceProblem> upload(Transport& transport,
                                                  const DfuFunctions& functions,
                                                  std::size_t max_bytes,
                                                  std::vector<std::byte>& out,
                                                  const Progress& progress);

/// Spoils what the selected slot holds: begins a download and gives it up.
[[nodiscard]] std::optional<DeviceProblem> discard(Transport& transport,
                                                   const DfuFunctions& functions, Clock& clock);

}  // namespace palpate::hal::flash
