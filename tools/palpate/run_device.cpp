// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/run_device.hpp"

#include <algorithm>

#include "hal/mock/device.hpp"
#include "tools/palpate/command.hpp"
#include "tools/realtime/realtime_thread.hpp"
#include "tools/realtime/scene_hand.hpp"

namespace palpate::cli {
namespace {

/// Readings of the mock device for each tick, so that what a tick uses is at most half a period
/// old.
constexpr double kMockReadingsPerTick = 2.0;
/// No hand is faster, and a small tool is not led through more than so many of its radii a second.
constexpr double kFastestHand_m_per_s = 1.0;
constexpr double kRadiiPerSecond = 10;
/// The mouse pulls with so much of what a device may push back with, and no harder than presses the
/// tool in by this share of its radius: who pulls harder is let through, by any device.
constexpr double kPullOfMost = 0.8;
constexpr double kPressedInOfRadius = 0.1;
constexpr double kFastestTurn_rad_per_s = 6;
constexpr double kFarthestTurn_rad = 0.5;

hal::mock::FollowLimits mouse_limits(const config::Scene& scene, double radius_m) {
  const config::MockHand& hand = scene.hand;
  if (!(hand.grip_N_per_m > 0) || !(hand.grip_Nm_per_rad > 0)) {
    throw Failure(kUsage, "the mouse pulls the tool by the hand's grip, which is 0",
                  scene.file.string(), "give [mock] a grip_N_per_m and a grip_Nm_per_rad above 0");
  }
  const hal::mock::Options device;
  const double most_N = std::min(scene.settings.max_force_N, device.max_force_N);
  const double most_Nm = std::min(scene.settings.max_torque_Nm, device.max_torque_Nm);
  const double press_N = kPressedInOfRadius * radius_m * scene.settings.stiffness_N_per_m;
  const double pull_N = std::min(kPullOfMost * most_N, press_N);
  hal::mock::FollowLimits limits;
  limits.speed_m_per_s = std::min(kFastestHand_m_per_s, kRadiiPerSecond * radius_m);
  limits.turn_rad_per_s = kFastestTurn_rad_per_s;
  limits.ahead_m = pull_N / hand.grip_N_per_m;
  limits.ahead_rad = std::min(kPullOfMost * most_Nm / hand.grip_Nm_per_rad, kFarthestTurn_rad);
  return limits;
}

std::unique_ptr<hal::mock::MockDevice> make_mock(const RunDeviceOptions& options,
                                                 const config::Scene& scene,
                                                 const hal::mock::Options& led) {
  hal::mock::Options mock = led;
  mock.rate_Hz = kMockReadingsPerTick * options.rate_Hz;
  // It stands in for hardware, which the loop does not keep waiting either.
  const int priority = options.loop_priority;
  mock.fifo_priority = priority == 0 ? 0 : std::min(priority + 1, realtime::kMaxFifoPriority);
  hal::mock::HandParameters hand = realtime::hand_of(scene);
  if (led.led) hand.script.clear();
  return std::make_unique<hal::mock::MockDevice>(std::move(hand), mock);
}

}  // namespace

bool is_mock_hand(const std::string& device) { return device == "mock" || device == "mouse"; }

RunDevice make_run_device(const RunDeviceOptions& options, const config::Scene& scene,
                          const SceneEngine& engine, hal::Clock& clock) {
  RunDevice out;
  if (options.name == "mouse") {
    hal::mock::Options led;
    led.led = mouse_limits(scene, engine.images()[scene.tool].header->radius_m);
    auto mock = make_mock(options, scene, led);
    out.lead = [hand = mock.get()](const Pose& to) { hand->lead(to); };
    out.device = std::move(mock);
  } else if (options.name == "mock") {
    out.device = make_mock(options, scene, {});
  } else {
    // Below the loop, which does not wait for it; above everything else.
    out.device = make_usb_device(options.name, options.firmware, engine.image_hashes(), clock,
                                 std::max(options.loop_priority - 1, 0));
  }
  return out;
}

}  // namespace palpate::cli
