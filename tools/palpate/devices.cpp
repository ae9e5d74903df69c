// SPDX-License-Identifier: GPL-3.0-or-later
// palpate devices: the haptic devices found, how each is reached, and what is missing.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "hal/usb/find.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

std::string state_of(const hal::usb::FoundDevice& device) {
  return device.ready ? "ready" : "not usable";
}

void print(const hal::usb::FoundDevice& device) {
  const std::string serial = device.serial.empty() ? "" : ":" + device.serial;
  std::cout << hal::usb::name(device.kind) << serial << "  on USB " << device.path << ", "
            << state_of(device) << "\n";
  if (device.ready) return;
  std::cout << "    problem: " << device.problem << "\n    fix:     " << device.fix << "\n";
}

nlohmann::json to_json(const hal::usb::FoundDevice& device) {
  return {{"kind", hal::usb::name(device.kind)}, {"serial", device.serial},   {"path", device.path},
          {"state", state_of(device)},           {"problem", device.problem}, {"mend", device.fix}};
}

void devices(bool json) {
  const auto found = hal::usb::find_devices();
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& device : found) list.push_back(to_json(device));
    std::cout << list.dump(2) << "\n";
    return;
  }
  for (const auto& device : found) print(device);
  if (found.empty()) {
    std::cout << "No haptic device found. Is it plugged in and switched on? The mock device needs "
                 "none: palpate run SCENE --device mock\n";
  }
}

}  // namespace

void add_devices(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("devices", "List the haptic devices found and what keeps each from use");
  command->add_flag("--json", *json, "print a JSON list");
  command->callback([json] { devices(*json); });
}

}  // namespace palpate::cli
