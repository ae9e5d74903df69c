// SPDX-License-Identifier: GPL-3.0-or-later
// own_device IMAGE: a device class of one's own under Palpate's real-time loop.
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hal/clock.hpp"
#include "hal/device.hpp"
#include "hal/exchange.hpp"
#include "rt_core/palpate_rt.hpp"
#include "tools/realtime/engine_query.hpp"
#include "tools/realtime/loop.hpp"

namespace {

using namespace palpate;

/// A stylus of 50 g that a motor would push, and that someone's hand leads up and down. A thread
/// stands where a driver of yours talks to the bus.
class Stylus final : public hal::Device {
 public:
  explicit Stylus(hal::Clock& clock) : clock_(clock) {}
  ~Stylus() override { stop(); }

  hal::Capabilities capabilities() const noexcept override {
    return {.max_force_N = 5, .rate_Hz = 2000, .sensed_dof = 3, .rendered_dof = 3};
  }
  std::optional<hal::DeviceProblem> open() override {
    // A driver says here what is missing, and how to fix it:
    // return hal::DeviceProblem{"open", "no such serial port", "plug it in"};
    return std::nullopt;
  }
  std::optional<hal::DeviceProblem> start() override {
    running_ = true;
    thread_ = std::thread([this] { talk_to_the_bus(); });
    return std::nullopt;
  }
  // The real-time thread's side: mailboxes, which never wait.
  bool receive(hal::DeviceState& out) noexcept override { return states_.read(out); }
  void send(const hal::DeviceCommand& command) noexcept override { commands_.write(command); }
  void stop() noexcept override {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }
  std::uint32_t faults() const noexcept override { return hal::kNoDeviceFault; }

 private:
  void talk_to_the_bus() {
    hal::DeviceCommand command;
    hal::DeviceState state;
    double height_m = kStart_m, speed_m_per_s = 0;
    const std::uint64_t start_ns = clock_.now_ns();
    for (std::uint64_t n = 1; running_; ++n) {
      clock_.sleep_until(start_ns + n * kPeriod_ns);
      const std::uint64_t now_ns = clock_.now_ns();
      static_cast<void>(commands_.read(command));
      // However the host has died: an old command renders nothing.
      const double force_N = now_ns < command.expires_ns ? command.wrench.force_N.z : 0;
      const double t_s = 1e-9 * static_cast<double>(now_ns - start_ns);
      const double hand_m = kStart_m - 0.002 * (1 - std::cos(12 * t_s)) / 2;
      speed_m_per_s += kStep_s * (force_N + 200 * (hand_m - height_m) - 3 * speed_m_per_s) / 0.05;
      height_m += kStep_s * speed_m_per_s;
      state.sequence = n;
      state.time_ns = now_ns;
      state.pose.position_m = {0, 0, height_m};
      states_.write(state);
    }
  }

  static constexpr std::uint64_t kPeriod_ns = 500'000;
  static constexpr double kStep_s = 0.0005, kStart_m = 0.017;  // they touch at 16 mm
  hal::Clock& clock_;
  hal::Mailbox<hal::DeviceState> states_;
  hal::Mailbox<hal::DeviceCommand> commands_;
  std::atomic<bool> running_{false};
  std::thread thread_;
};

/// Memory as images and engines want it.
struct Free {
  void operator()(std::byte* p) const { ::operator delete (p, std::align_val_t{64}); }
};
using Memory = std::unique_ptr<std::byte, Free>;
Memory memory_of(std::size_t bytes) {
  return Memory(static_cast<std::byte*>(::operator new (bytes, std::align_val_t{64})));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "usage: own_device IMAGE\n"), 2;
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
  const Settings settings{.engine = EngineKind::regions, .delta_m = 0.0005};
  const std::size_t bytes = required_bytes(scene, {}, settings.engine);
  const Memory memory = memory_of(bytes);
  Engine* engine = nullptr;
  if (create(scene, settings, {}, {memory.get(), bytes}, engine) != Status::ok) return 1;

  hal::MonotonicClock clock;
  Stylus device(clock);
  const std::array<Pose, 2> poses{Pose{{0, 0, 0.017}, {}}, Pose{}};
  realtime::EngineQuery query(*engine, poses, 0);
  realtime::LoopSettings how;
  how.periods = 1000;
  how.query_time.budget_us = 300;
  how.fixed_orientation = Quat{};  // it senses none
  how.safety.max_force_N = 3;
  const auto loop = std::make_unique<realtime::Loop>(how, device, query, clock, nullptr);
  if (device.open() || device.start()) return 4;
  const std::atomic<bool> stop{false};
  loop->run(stop);
  device.stop();

  const realtime::LoopReport& report = loop->report();
  std::printf("%llu ticks, %llu missed, %llu touching; force at most %.3f N\n",
              static_cast<unsigned long long>(report.ticks),
              static_cast<unsigned long long>(report.missed),
              static_cast<unsigned long long>(report.touching), report.force_N_max);
  // A desktop may miss so many deadlines in a row that the loop lets go of the force.
  for (const std::string_view fault : realtime::names(report.faults)) {
    std::printf("force ended by %s\n", std::string(fault).c_str());
  }
  return report.ticks > 0 ? 0 : 4;
}
