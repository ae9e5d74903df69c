// SPDX-License-Identifier: Apache-2.0
// simulated_usb IMAGE: a device of the open USB protocol, all of it but the cable.
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include "hal/clock.hpp"
#include "hal/protocol/host_driver.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/simulator/port.hpp"
#include "hal/transport/streamed_device.hpp"
#include "rt_core/palpate_rt.hpp"

namespace {

using namespace palpate;

constexpr std::uint64_t kPeriod_ns = 1'000'000;

/// Memory as images and engines want it.
struct Free {
  void operator()(std::byte* p) const { ::operator delete (p, std::align_val_t{64}); }
};
using Memory = std::unique_ptr<std::byte, Free>;
Memory memory_of(std::size_t bytes) {
  return Memory(static_cast<std::byte*>(::operator new (bytes, std::align_val_t{64})));
}

std::uint64_t clock_of(void* clock) { return static_cast<hal::Clock*>(clock)->now_ns(); }

/// The hand that holds the device: down until the bodies touch, and up again. They touch at 16 mm.
hal::mock::HandParameters hand() {
  hal::mock::HandParameters hand;
  hand.script = {{0, {{0, 0, 0.017}, {}}}, {0.4, {{0, 0, 0.0152}, {}}}, {0.8, {{0, 0, 0.017}, {}}}};
  return hand;
}

int fail(const hal::DeviceProblem& problem) {
  std::fprintf(stderr, "device failed at %s: %s: %s\n", problem.phase.c_str(),
               problem.cause.c_str(), problem.fix.c_str());
  return 4;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "usage: simulated_usb IMAGE\n"), 2;
  std::ifstream file(arguments[1], std::ios::binary);
  const std::vector<char> read{std::istreambuf_iterator<char>(file), {}};
  const Memory image = memory_of(read.size());
  std::copy(read.begin(), read.end(), reinterpret_cast<char*>(image.get()));
  std::array<ImageView, 2> views;
  const Status sound = validate({image.get(), read.size()}, views[0]);
  if (sound != Status::ok) {
    return std::fprintf(stderr, "%s: %s\n", arguments[1], describe(sound)), 3;
  }
  views[1] = views[0];
  const std::array<BodyPair, 1> pairs{{{0, 1}}};
  const Scene scene{views, pairs, 0};
  // The loop below has no stage of safety of its own: the engine's limit is the only one.
  const Settings settings{.engine = EngineKind::regions, .delta_m = 0.0005, .max_force_N = 3};
  const std::size_t bytes = required_bytes(scene, {}, settings.engine);
  const Memory memory = memory_of(bytes);
  Engine* engine = nullptr;
  if (create(scene, settings, {}, {memory.get(), bytes}, engine) != Status::ok) return 1;

  // With hardware, hal::usb::open_transport() stands in the place of the simulator's port.
  hal::MonotonicClock clock;
  hal::simulator::OpenDeviceOptions options;
  options.hand = hand();
  hal::simulator::OpenDevice model(options);
  hal::StreamedDevice device(std::make_unique<hal::simulator::Port>(model, clock),
                             std::make_unique<hal::protocol::HostDriver>(), clock, {});
  if (const auto problem = device.open()) return fail(*problem);
  if (const auto problem = device.start()) return fail(*problem);
  std::printf("a device of %.0f readings a second, %.0f N\n", device.capabilities().rate_Hz,
              device.capabilities().max_force_N);

  hal::DeviceState state;
  hal::DeviceCommand command;
  double most_N = 0;
  std::uint64_t touching = 0;
  const std::uint64_t start_ns = clock.now_ns();
  for (std::uint64_t n = 0; n < 800; ++n) {
    clock.sleep_until(start_ns + n * kPeriod_ns);
    static_cast<void>(device.receive(state));
    const std::array<Pose, 2> poses{state.pose, Pose{}};
    Budget budget;
    budget.clock_ns = clock_of;
    budget.clock_context = &clock;
    budget.deadline_ns = clock.now_ns() + 300'000;
    TickResult result;
    if (tick(*engine, poses, budget, result) != Status::ok) result = {};  // no force in doubt
    command.sequence = n + 1;
    command.time_ns = clock.now_ns();
    command.expires_ns = command.time_ns + 20'000'000;
    command.wrench = result.wrench;
    command.answers = state.sequence;
    command.state_time_ns = state.time_ns;
    device.send(command);
    most_N = std::max(most_N, result.wrench.force_N.z);
    touching += result.contacts.empty() ? 0 : 1;
  }
  device.stop();
  std::printf("%llu ticks touching; force at most %.3f N; faults %u\n",
              static_cast<unsigned long long>(touching), most_N, device.faults());
  return touching > 0 ? 0 : 4;  // faults: on a busy machine commands may come too late for it
}
