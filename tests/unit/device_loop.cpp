// SPDX-License-Identifier: GPL-3.0-or-later
// The real-time loop against simulated USB devices in virtual time: everything from the contact
// query to the encoders but the kernel and the engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "../support/simulated_rig.hpp"
#include "../support/virtual_loop.hpp"
#include "hal/falcon/driver.hpp"
#include "hal/simulator/falcon_device.hpp"

namespace palpate::realtime {
namespace {

using hal::mock::FaultKind;
using hal::mock::FaultWindow;
using hal::simulator::FalconDevice;
using hal::simulator::FalconDeviceOptions;
using hal::simulator::OpenDevice;
using hal::simulator::OpenDeviceOptions;
using hal::simulator::PortFaults;
using hal::test::kMs;

/// The loop's clock: while it sleeps, the I/O thread's steps and the device's life go on.
class PumpedClock final : public hal::Clock {
 public:
  explicit PumpedClock(hal::Clock& clock) : clock_(clock) {}
  std::uint64_t now_ns() noexcept override { return clock_.now_ns(); }
  void sleep_until(std::uint64_t time_ns) noexcept override {
    while (clock_.now_ns() < time_ns) {
      if (io_lives && device != nullptr) io_lives = device->step();
      if (!io_lives) clock_.sleep_until(clock_.now_ns() + kMs / 10);
      each_step();
    }
  }
  hal::StreamedDevice* device = nullptr;
  bool io_lives = true;
  std::function<void()> each_step = [] {};

 private:
  hal::Clock& clock_;
};

/// The hand presses the tool 5 mm into the wall z < 0 again and again.
hal::mock::HandParameters pressing_hand() {
  hal::mock::HandParameters hand;
  hand.script = {{0, {{0, 0, 0.005}, {}}}, {0.5, {{0, 0, -0.005}, {}}}, {1, {{0, 0, 0.005}, {}}}};
  return hand;
}

LoopSettings seconds_of(double s) {
  LoopSettings settings;
  settings.periods = static_cast<std::uint64_t>(1000 * s);
  settings.safety.max_force_N = 5;
  return settings;
}

struct UsbLoop {
  UsbLoop(hal::simulator::SimulatedDevice& model, std::unique_ptr<hal::Driver> driver,
          const LoopSettings& settings, PortFaults faults = {})
      : rig(model, clock, std::move(driver), std::move(faults)),
        pumped(clock),
        query(test::wall(600)),
        loop(settings, *rig.device, query, pumped, nullptr) {
    pumped.device = rig.device.get();
  }
  const LoopReport& run() {
    EXPECT_FALSE(rig.begin());
    loop.run(stop);
    return loop.report();
  }
  hal::test::VirtualClock clock;
  hal::test::SimulatedRig rig;
  PumpedClock pumped;
  test::QueryOf query;
  Loop loop;
  std::atomic<bool> stop{false};
};

struct OpenLoop : UsbLoop {
  explicit OpenLoop(OpenDevice& a_model, const LoopSettings& settings, PortFaults faults = {})
      : UsbLoop(a_model, std::make_unique<hal::protocol::HostDriver>(), settings,
                std::move(faults)) {}
};

OpenDeviceOptions pressing() {
  OpenDeviceOptions options;
  options.hand = pressing_hand();
  return options;
}

PortFaults faults_of(std::vector<FaultWindow> in, std::vector<FaultWindow> out = {}) {
  return {{std::move(in), 1}, {std::move(out), 2}};
}

TEST(DeviceLoop, wall_is_felt_through_the_open_protocol) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(3));
  const LoopReport& report = rig.run();
  EXPECT_EQ(report.state, LoopState::rendering);
  EXPECT_TRUE(report.faults.empty());
  EXPECT_EQ(report.missed, 0u);
  EXPECT_GT(report.force_N_max, 0.5);
  // The hand's spring and the wall's in series: 5 mm against 300 and 600 N/m is 1 N.
  EXPECT_NEAR(report.force_N_max, 1.0, 0.1);
  EXPECT_LE(report.state_age.max_ns(), kMs);
}

TEST(DeviceLoop, wall_is_felt_through_the_falcon_once_it_is_homed) {
  FalconDeviceOptions options;
  options.hand = pressing_hand();
  options.firmware_runs = true;
  FalconDevice model(options);
  UsbLoop rig(model, std::make_unique<hal::falcon::FalconDriver>(std::vector<std::byte>{}),
              seconds_of(3));
  const LoopReport& report = rig.run();
  EXPECT_EQ(report.state, LoopState::rendering);
  EXPECT_TRUE(report.faults.empty());
  EXPECT_NEAR(report.force_N_max, 1.0, 0.1);
  EXPECT_NEAR(static_cast<double>(report.homing), 500, 10);
  EXPECT_EQ(report.ticks, 3000 + report.homing);
}

TEST(DeviceLoop, falcon_that_nobody_homes_is_a_fault_without_any_force) {
  FalconDeviceOptions options;
  options.firmware_runs = true;
  options.homed_after_s = 1e9;
  FalconDevice model(options);
  LoopSettings settings = seconds_of(1);
  settings.safety.home_within_s = 0.5;
  UsbLoop rig(model, std::make_unique<hal::falcon::FalconDriver>(std::vector<std::byte>{}),
              settings);
  const LoopReport& report = rig.run();
  EXPECT_EQ(report.state, LoopState::fault);
  EXPECT_TRUE(report.faults.has(Fault::not_homed));
  EXPECT_EQ(report.queried, 0u);
  EXPECT_EQ(model.motors(), hal::falcon::MotorValues{});
}

TEST(DeviceLoop, zero_that_is_lost_while_rendering_is_a_fault) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2));
  bool lost = false;
  rig.pumped.each_step = [&] {
    if (lost || norm(model.rendered().force_N) < 0.5) return;
    lost = true;
    model.set_homing(true);
  };
  const LoopReport& report = rig.run();
  EXPECT_TRUE(lost);
  EXPECT_EQ(report.state, LoopState::fault);
  EXPECT_TRUE(report.faults.has(Fault::not_homed));
  EXPECT_EQ(norm(model.rendered().force_N), 0.0);
}

TEST(DeviceLoop, unplugging_is_a_device_error_at_once) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2), faults_of({{FaultKind::unplug, 1.5, 100, 0, 1}}));
  const LoopReport& report = rig.run();
  EXPECT_EQ(report.state, LoopState::fault);
  EXPECT_TRUE(report.faults.has(Fault::device_error));
  EXPECT_EQ(norm(model.rendered().force_N), 0.0);
}

TEST(DeviceLoop, report_says_what_the_device_said_and_in_which_tick) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2), faults_of({{FaultKind::unplug, 1.5, 100, 0, 1}}));
  const LoopReport& report = rig.run();
  EXPECT_EQ(report.device_faults, hal::kDeviceLost);
  EXPECT_NEAR(static_cast<double>(report.device_fault_ticks[0]), 1500, 3);
  EXPECT_EQ(report.fault_ticks[static_cast<std::size_t>(Fault::device_error)],
            report.device_fault_ticks[0]);
}

TEST(DeviceLoop, last_tick_leaves_no_force_two_periods_later) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(1.5));
  double last_N = 0;
  rig.pumped.each_step = [&] { last_N = norm(model.rendered().force_N); };
  EXPECT_EQ(rig.run().state, LoopState::rendering);
  EXPECT_GT(last_N, 0.5);
  rig.pumped.sleep_until(rig.clock.now_ns() + 2 * kMs);
  EXPECT_EQ(norm(model.rendered().force_N), 0.0);
}

TEST(DeviceLoop, silent_device_is_a_stale_state) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2));
  rig.pumped.each_step = [&] { model.set_silent(rig.clock.now_ns() > 2500 * kMs); };
  const LoopReport& report = rig.run();
  EXPECT_EQ(report.state, LoopState::fault);
  EXPECT_TRUE(report.faults.has(Fault::stale_state));
}

TEST(DeviceLoop, readings_that_are_held_up_are_a_stale_state) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2), faults_of({{FaultKind::delay, 1.0, 100, 0.2, 1}}));
  const LoopReport& report = rig.run();
  EXPECT_TRUE(report.faults.has(Fault::stale_state));
}

TEST(DeviceLoop, commands_that_do_not_arrive_are_a_device_error) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2), faults_of({}, {{FaultKind::drop, 1.0, 100, 0, 1}}));
  const LoopReport& report = rig.run();
  EXPECT_TRUE(report.faults.has(Fault::device_error));
  EXPECT_EQ(model.mode(), hal::protocol::Mode::expired);
}

/// Does as it is told until a time; what it does then is given.
class Disobedient final : public OpenDevice {
 public:
  enum class How : std::uint8_t { refuses, ignores, idles };
  explicit Disobedient(How how) : OpenDevice(pressing()), how_(how) {}
  /// From now on.
  void begin() {
    begun_ = true;
    if (how_ == How::refuses) bus_reset();  // its session is over
  }
  void out(std::span<const std::byte> bytes) override {
    if (begun_ && how_ == How::ignores) return;
    OpenDevice::out(bytes);
  }
  std::size_t in(std::span<std::byte> buffer) override {
    const std::size_t length = OpenDevice::in(buffer);
    hal::protocol::State state;
    if (!begun_ || length == 0 ||
        hal::protocol::decode(buffer.first(length), state) != hal::protocol::PacketError::none) {
      return length;
    }
    // One that ignores says what it did when it still listened.
    if (how_ == How::ignores) state.mode = hal::protocol::Mode::active;
    if (how_ == How::idles) state.mode = hal::protocol::Mode::idle;
    const auto packet = encode(state);
    std::copy(packet.begin(), packet.end(), buffer.begin());
    return length;
  }

 private:
  How how_;
  bool begun_ = false;
};

TEST(DeviceLoop, device_that_does_not_do_as_it_is_told_is_a_named_fault_within_50_ms) {
  using How = Disobedient::How;
  const std::vector<std::pair<How, std::uint32_t>> cases = {{How::refuses, hal::kDeviceRefuses},
                                                            {How::ignores, hal::kDeviceIgnores},
                                                            {How::idles, hal::kDeviceIdle}};
  for (const auto& each : cases) {
    const std::uint32_t fault = each.second;
    Disobedient model(each.first);
    OpenLoop rig(model, seconds_of(3));
    std::uint64_t begun_ns = 0, known_ns = 0;
    rig.pumped.each_step = [&] {
      const std::uint64_t now_ns = rig.clock.now_ns();
      if (begun_ns == 0 && now_ns > 1500 * kMs && norm(model.rendered().force_N) > 0.5) {
        model.begin();
        begun_ns = now_ns;
      }
      if (known_ns == 0 && (rig.rig.device->faults() & fault) != 0) known_ns = now_ns;
    };
    const LoopReport& report = rig.run();
    ASSERT_GT(begun_ns, 0u);
    EXPECT_EQ(report.state, LoopState::fault);
    EXPECT_TRUE(report.faults.has(Fault::device_error));
    ASSERT_GT(known_ns, 0u);
    EXPECT_LE(known_ns - begun_ns, 50 * kMs);
    EXPECT_EQ(norm(model.rendered().force_N), 0.0);
  }
}

TEST(DeviceLoop, few_lost_and_damaged_packets_go_unnoticed) {
  const std::vector<FaultWindow> script = {{FaultKind::drop, 0, 100, 0, 0.01},
                                           {FaultKind::repeat, 0, 100, 0, 0.01},
                                           {FaultKind::reorder, 0, 100, 0, 0.01},
                                           {FaultKind::corrupt, 0, 100, 3, 0.01},
                                           {FaultKind::truncate, 0, 100, 9, 0.01}};
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(5), faults_of(script, script));
  const LoopReport& report = rig.run();
  EXPECT_EQ(report.state, LoopState::rendering);
  EXPECT_TRUE(report.faults.empty());
  EXPECT_NEAR(report.force_N_max, 1.0, 0.1);
}

TEST(DeviceLoop, dead_io_thread_leaves_no_force_within_the_commands_life) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2));
  std::uint64_t died_ns = 0, last_force_ns = 0;
  rig.pumped.each_step = [&] {
    const std::uint64_t now_ns = rig.clock.now_ns();
    if (died_ns == 0 && now_ns > 1500 * kMs && norm(model.rendered().force_N) > 0.5) {
      rig.pumped.io_lives = false;
      died_ns = now_ns;
    }
    model.advance_to(now_ns);
    if (norm(model.rendered().force_N) > 0) last_force_ns = now_ns;
  };
  const LoopReport& report = rig.run();
  ASSERT_GT(died_ns, 0u);
  EXPECT_TRUE(report.faults.has(Fault::stale_state));
  EXPECT_LE(last_force_ns - died_ns, 21 * kMs);
}

TEST(DeviceLoop, fault_ramps_to_zero_at_the_device) {
  OpenDevice model(pressing());
  OpenLoop rig(model, seconds_of(2));
  bool spoilt = false;
  rig.pumped.each_step = [&] {
    if (spoilt || norm(model.rendered().force_N) < 0.5) return;
    spoilt = true;
    model.set_health(hal::protocol::kMotorFailure);
  };
  const LoopReport& report = rig.run();
  EXPECT_TRUE(spoilt);
  EXPECT_TRUE(report.faults.has(Fault::device_error));
  EXPECT_EQ(norm(model.rendered().force_N), 0.0);
}

}  // namespace
}  // namespace palpate::realtime
