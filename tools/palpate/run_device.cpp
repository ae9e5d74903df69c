// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/run_device.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>
#include <variant>

#include "hal/mock/device.hpp"
#include "tools/palpate/command.hpp"
#include "tools/realtime/realtime_thread.hpp"
#include "tools/realtime/scene_hand.hpp"

namespace palpate::cli {
namespace {

/// Readings of the mock device for each tick, so that what a tick uses is at most half a period
/// old.
constexpr double kMockReadingsPerTick = 2.0;
/// No hand is faster.
constexpr double kFastestHand_m_per_s = 1.0;
/// How deep the mouse may press, in radii of the smallest body: what goes deeper than the thinnest
/// part of a body, a gear's tooth for one, comes out on its other side, with any device.
constexpr double kDeepestOfRadius = 0.05;
/// The mouse's share of the contacts' force there.
constexpr double kPullOfContact = 0.25;
constexpr double kFastestTurn_rad_per_s = 6;
constexpr double kFarthestTurn_rad = 0.5;
/// A SpaceMouse pushed all the way: so many radii of the smallest body a second.
constexpr double kPushOfRadius_per_s = 1;
constexpr double kPushTurns_rad_per_s = 1.5;

/// The contacts stop the hand's mass within that depth d although it pulls: with F the force there,
/// m v^2 / 2 + F d / 4 = F d / 2.
hal::mock::FollowLimits mouse_limits(const config::Scene& scene, double radius_m) {
  const config::MockHand& hand = scene.hand;
  if (!(hand.grip_N_per_m > 0) || !(hand.grip_Nm_per_rad > 0)) {
    throw Failure(kUsage, "the mouse pulls the tool by the hand's grip, which is 0",
                  scene.file.string(), "give [mock] a grip_N_per_m and a grip_Nm_per_rad above 0");
  }
  const hal::mock::Options device;
  const double most_N = std::min(scene.settings.max_force_N, device.max_force_N);
  const double most_Nm = std::min(scene.settings.max_torque_Nm, device.max_torque_Nm);
  const double deepest_m = kDeepestOfRadius * radius_m;
  const double contact_N = std::min(most_N, scene.settings.stiffness_N_per_m * deepest_m);
  const double pull_N = kPullOfContact * contact_N;
  const double stopped_m_per_s = std::sqrt(contact_N * deepest_m / (2 * hand.mass_kg));
  hal::mock::FollowLimits limits;
  limits.speed_m_per_s = std::min(kFastestHand_m_per_s, stopped_m_per_s);
  limits.turn_rad_per_s = kFastestTurn_rad_per_s;
  limits.ahead_m = pull_N / hand.grip_N_per_m;
  limits.ahead_rad = std::min(kPullOfContact * most_Nm / hand.grip_Nm_per_rad, kFarthestTurn_rad);
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

double least_radius_m(const config::Scene& scene, const SceneEngine& engine) {
  double radius_m = engine.images()[scene.tool].header->radius_m;
  for (const ImageView& body : engine.images()) {
    radius_m = std::min<double>(radius_m, body.header->radius_m);
  }
  return radius_m;
}

std::unique_ptr<spacemouse::Leader> lead_by_space_mouse(
    double radius_m, std::function<void(const hal::mock::Lead&)> lead) {
  auto opened = spacemouse::open_puck();
  if (const auto* problem = std::get_if<hal::DeviceProblem>(&opened)) fail("spacemouse", *problem);
  const spacemouse::Pace pace{kPushOfRadius_per_s * radius_m, kPushTurns_rad_per_s};
  return std::make_unique<spacemouse::Leader>(
      std::move(std::get<std::unique_ptr<spacemouse::Puck>>(opened)), pace, std::move(lead),
      [] { std::cerr << "The SpaceMouse is gone: nothing leads the tool any more.\n"; });
}

}  // namespace

bool is_mock_hand(const std::string& device) {
  return device == "mock" || device == "mouse" || device == "spacemouse";
}

RunDevice make_run_device(const RunDeviceOptions& options, const config::Scene& scene,
                          const SceneEngine& engine, hal::Clock& clock) {
  RunDevice out;
  if (options.name == "mouse" || options.name == "spacemouse") {
    const double radius_m = least_radius_m(scene, engine);
    hal::mock::Options led;
    led.led = mouse_limits(scene, radius_m);
    auto mock = make_mock(options, scene, led);
    const auto lead = [hand = mock.get()](const hal::mock::Lead& said) { hand->lead(said); };
    out.device = std::move(mock);
    if (options.name == "mouse") {
      out.lead = lead;
    } else {
      out.leader = lead_by_space_mouse(radius_m, lead);
    }
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
