// SPDX-License-Identifier: GPL-3.0-or-later
// What ended the rendering of a run, in words, and how to fix it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/realtime/loop.hpp"

namespace palpate::cli {

struct FaultNote {
  std::string fault;   ///< as realtime::name() has it
  std::string device;  ///< what the device said, in one word; empty where it said nothing
  std::uint64_t tick = 0;
  std::string cause;
  std::string fix;
};

/// A note for each fault, and for each of the device's own, in the order in which they came.
[[nodiscard]] std::vector<FaultNote> fault_notes(const realtime::LoopReport& report);

/// "unplugged", "motor_failure" and so on: the names of DeviceFault bits.
[[nodiscard]] std::vector<std::string> device_fault_names(std::uint32_t faults);

}  // namespace palpate::cli
