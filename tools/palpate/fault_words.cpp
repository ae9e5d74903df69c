// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/fault_words.hpp"

#include <algorithm>
#include <array>

namespace palpate::cli {
namespace {

using realtime::Fault;

struct DeviceWords {
  const char* name;
  const char* cause;
  const char* fix;
};

/// By the number of the bit of hal::DeviceFault.
constexpr std::array<DeviceWords, hal::kDeviceFaultKinds> kDeviceWords = {{
    {"unplugged", "the device was unplugged, or the bus failed",
     "plug it in again, then start the next run"},
    {"bad_command", "the device was sent a number that is not finite",
     "please report it with the scene"},
    {"overheated", "the device has reduced its force because it is hot", "let it cool down"},
    {"bad_reading", "a sensor of the device reads what cannot be right",
     "switch the device off and on; if it stays, it needs repair"},
    {"motor_failure", "the device has failed: a motor, its power or its own checks",
     "look at its power supply, switch it off and on; if it stays, it needs repair"},
    {"silenced", "the device ended the force because commands came too late",
     "'palpate doctor' says what this host lacks; then start the next run"},
    {"refused", "the device refuses the commands that it is sent",
     "switch the device off and on; if it stays, its firmware does not follow docs/PROTOCOL.md"},
    {"ignored", "the device does not answer the commands that it is sent",
     "switch the device off and on; if it stays, its firmware does not follow docs/PROTOCOL.md"},
    {"fell_idle", "the device takes commands and renders no force",
     "look for a switch on the device that turns its motors off; then start the next run"},
}};

struct FaultWords {
  Fault fault;
  const char* cause;
  const char* fix;
};

constexpr std::array<FaultWords, realtime::kFaultCount> kFaultWords = {{
    {Fault::stale_state, "no fresh reading came from the device",
     "look at its cable and hub, and at 'palpate devices'; then start the next run"},
    {Fault::bad_state, "the device sent a pose that is not finite", "update the device's firmware"},
    {Fault::missed_deadlines, "ticks ended late, one after the other",
     "'palpate doctor' says what this host lacks; or give budget_us or a lower --rate"},
    {Fault::engine_error, "the contact engine refused a pose, or its thread stopped",
     "please report it with the scene and a trace (-o)"},
    {Fault::bad_wrench, "the contact engine returned a number that is not finite",
     "please report it with the scene and a trace (-o)"},
    {Fault::device_error, "the device reported a fault", "start the next run"},
    {Fault::not_homed, "the device has not found its zero, or lost it",
     "home it as docs/DEVICES.md says in the next run"},
}};

bool has_bit(std::uint32_t bits, std::size_t i) { return (bits >> i & 1u) != 0; }

}  // namespace

std::vector<FaultNote> fault_notes(const realtime::LoopReport& report) {
  std::vector<FaultNote> notes;
  const bool explained = (report.device_faults & ~std::uint32_t{hal::kDeviceOverheated}) != 0;
  for (const FaultWords& words : kFaultWords) {
    const auto i = static_cast<std::size_t>(words.fault);
    // What the device said stands for the fault that it became.
    if (!report.faults.has(words.fault)) continue;
    if (words.fault == Fault::device_error && explained) continue;
    notes.push_back({std::string(realtime::name(words.fault)), "", report.fault_ticks[i],
                     words.cause, words.fix});
  }
  const std::string device_error(realtime::name(Fault::device_error));
  for (std::size_t i = 0; i < kDeviceWords.size(); ++i) {
    if (!has_bit(report.device_faults, i)) continue;
    const bool harmless = has_bit(hal::kDeviceOverheated, i);
    notes.push_back({harmless ? "" : device_error, kDeviceWords[i].name,
                     report.device_fault_ticks[i], kDeviceWords[i].cause, kDeviceWords[i].fix});
  }
  std::stable_sort(notes.begin(), notes.end(),
                   [](const FaultNote& a, const FaultNote& b) { return a.tick < b.tick; });
  return notes;
}

std::vector<std::string> device_fault_names(std::uint32_t faults) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kDeviceWords.size(); ++i) {
    if (has_bit(faults, i)) names.emplace_back(kDeviceWords[i].name);
  }
  return names;
}

}  // namespace palpate::cli
