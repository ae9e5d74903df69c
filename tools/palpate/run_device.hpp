// SPDX-License-Identifier: GPL-3.0-or-later
// The device of `palpate run`.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "hal/device.hpp"
#include "hal/mock/follower.hpp"
#include "tools/palpate/device_choice.hpp"
#include "tools/palpate/scene_engine.hpp"
#include "tools/spacemouse/leader.hpp"

namespace palpate::cli {

struct RunDevice {
  std::unique_ptr<hal::Device> device;
  /// Where the tool is led, from one other thread; empty: the device does not take that.
  std::function<void(const hal::mock::Lead&)> lead;
  std::unique_ptr<spacemouse::Leader> leader;  ///< leads the device; null: nothing does
};

struct RunDeviceOptions {
  std::string name;  ///< as the user gave it
  std::filesystem::path firmware;
  int loop_priority = 0;
  double rate_Hz = 1000;  ///< of the loop
};

/// Whether it is a simulated hand.
[[nodiscard]] bool is_mock_hand(const std::string& device);

/// Not yet open. Throws Failure as make_usb_device() does, kUsage where a mouse has nothing to
/// pull by, and kDevice where there is no SpaceMouse.
[[nodiscard]] RunDevice make_run_device(const RunDeviceOptions& options, const config::Scene& scene,
                                        const SceneEngine& engine, hal::Clock& clock);

}  // namespace palpate::cli
