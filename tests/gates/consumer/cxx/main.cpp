// SPDX-License-Identifier: Apache-2.0
// consumer SCENE: the real-time loop on the mock device, with a wall of its own in place of the
// scene's contacts.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>

#include "config/scene.hpp"
#include "hal/clock.hpp"
#include "hal/mock/device.hpp"
#include "hal/usb/find.hpp"
#include "tools/realtime/loop.hpp"
#include "tools/realtime/scene_hand.hpp"

namespace {

/// Pushes up as far as the tool is below the floor.
struct Floor : palpate::realtime::ContactQuery {
  palpate::Status tick(const palpate::Pose& tool, const palpate::Budget&,
                       palpate::TickResult& out) noexcept override {
    out = {};
    out.wrench.force_N.z = 300 * std::max(0.0, 1 - tool.position_m.z);
    return palpate::Status::ok;
  }
};

}  // namespace

int main(int, char** arguments) {
  const palpate::config::Scene scene = palpate::config::load_scene(arguments[1]);
  palpate::hal::mock::MockDevice device(palpate::realtime::hand_of(scene), {});
  if (device.open() || device.start()) return 1;
  palpate::hal::MonotonicClock clock;
  palpate::realtime::LoopSettings settings;
  settings.periods = 100;
  Floor floor;
  const auto loop =
      std::make_unique<palpate::realtime::Loop>(settings, device, floor, clock, nullptr);
  std::atomic<bool> stop{false};
  loop->run(stop);
  device.stop();
  std::printf("%zu bodies, %llu ticks; %zu devices on USB\n", scene.bodies.size(),
              static_cast<unsigned long long>(loop->report().ticks),
              palpate::hal::usb::find_devices().size());
  return loop->report().ticks + loop->report().missed > 0 ? 0 : 1;
}
