// SPDX-License-Identifier: Apache-2.0
// The I/O thread, the open protocol's driver and a simulated device together.
#include "hal/transport/streamed_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "../support/simulated_rig.hpp"

namespace palpate::hal {
namespace {

using namespace test;
using mock::FaultKind;
using mock::FaultWindow;
using simulator::OpenDevice;
using simulator::OpenDeviceOptions;
using simulator::PortFaults;

struct OpenRig : SimulatedRig {
  explicit OpenRig(OpenDevice& a_model, Clock& a_clock, PortFaults faults = {})
      : SimulatedRig(a_model, a_clock, std::make_unique<protocol::HostDriver>(), std::move(faults)),
        model(a_model) {}
  /// Until a time, pushing; how long the device rendered a force after the last command, in its own
  /// time.
  std::uint64_t force_periods_in(
      std::uint64_t for_ns, const std::function<void()>& tick = [] {}) {
    const std::uint64_t before = model.periods_with_force();
    run(for_ns, tick);
    return model.periods_with_force() - before;
  }
  OpenDevice& model;
};

constexpr std::uint64_t kPeriodsPerMs = 4;

PortFaults out_faults(std::vector<FaultWindow> script) { return {{}, {std::move(script), 1}}; }
PortFaults in_faults(std::vector<FaultWindow> script) { return {{std::move(script), 1}, {}}; }

TEST(StreamedDevice, capabilities_are_what_the_device_says) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  const Capabilities c = rig.device->capabilities();
  EXPECT_DOUBLE_EQ(c.max_force_N, 20.0);
  EXPECT_DOUBLE_EQ(c.max_torque_Nm, 1.0);
  EXPECT_DOUBLE_EQ(c.rate_Hz, 4000.0);
}

TEST(StreamedDevice, command_pushes_the_hand) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(1000 * kMs, [&] { rig.push(3.0); });
  EXPECT_NEAR(rig.reading.pose.position_m.x, 0.01, 1e-4);  // 3 N against 300 N/m
  EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
  EXPECT_EQ(model.mode(), protocol::Mode::active);
}

TEST(StreamedDevice, silent_loop_leaves_no_force_after_the_command_has_expired) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(100 * kMs, [&] { rig.push(3.0); });
  // 10 ms of life, and the packets under way.
  EXPECT_LE(rig.force_periods_in(200 * kMs), 11 * kPeriodsPerMs);
  EXPECT_EQ(norm(model.rendered().force_N), 0.0);
  EXPECT_EQ(rig.device->faults(), kDeviceSilenced);
  // Whoever fell silent does not get the force back by speaking again, but by a new start.
  EXPECT_EQ(rig.force_periods_in(100 * kMs, [&] { rig.push(3.0); }), 0u);
  rig.device->stop();
  ASSERT_FALSE(rig.device->start());
  EXPECT_GT(rig.force_periods_in(100 * kMs, [&] { rig.push(3.0); }), 90 * kPeriodsPerMs);
}

TEST(StreamedDevice, killed_host_leaves_no_force_after_the_devices_own_time) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(100 * kMs, [&] { rig.push(3.0); });
  const std::uint64_t before = model.periods_with_force();
  model.advance_to(clock.now_ns() + 500 * kMs);  // the device alone
  EXPECT_LE(model.periods_with_force() - before, 10 * kPeriodsPerMs);
  EXPECT_EQ(model.mode(), protocol::Mode::expired);
}

TEST(StreamedDevice, stop_ends_the_force_at_once) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(100 * kMs, [&] { rig.push(3.0); });
  rig.device->stop();
  const std::uint64_t before = model.periods_with_force();
  model.advance_to(clock.now_ns() + 100 * kMs);
  EXPECT_LE(model.periods_with_force() - before, 1u);
  EXPECT_EQ(model.mode(), protocol::Mode::idle);
}

TEST(StreamedDevice, swallowed_out_transfers_end_the_force_and_are_counted) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(100 * kMs, [&] { rig.push(3.0); });
  rig.port->hold_out(true);
  EXPECT_LE(rig.force_periods_in(100 * kMs, [&] { rig.push(3.0); }), 10 * kPeriodsPerMs);
  EXPECT_EQ(rig.port->pending(), simulator::Port::kOutTransfers);
  EXPECT_GT(rig.device->crowded_out(), 50u);
  // The device has given the host up: that is a fault, and it stays without force.
  rig.port->hold_out(false);
  EXPECT_EQ(rig.force_periods_in(100 * kMs, [&] { rig.push(3.0); }), 0u);
  EXPECT_EQ(rig.reading.faults, kDeviceSilenced);
}

TEST(StreamedDevice, silent_device_shows_as_an_old_reading) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(20 * kMs, [&] { rig.push(1.0); });
  model.set_silent(true);
  rig.run(200 * kMs, [&] { rig.push(1.0); });
  EXPECT_GT(clock.now_ns() - rig.reading.time_ns, 199 * kMs);
  // And commands that answer it are refused by the device.
  EXPECT_EQ(norm(model.rendered().force_N), 0.0);
}

TEST(StreamedDevice, unplugged_device_is_lost_and_comes_back_without_force) {
  VirtualClock clock;
  OpenDevice model({});
  {
    OpenRig rig(model, clock, in_faults({{FaultKind::unplug, 0.1, 10, 0, 1}}));
    ASSERT_FALSE(rig.begin());
    rig.run(200 * kMs, [&] { rig.push(3.0); });
    EXPECT_EQ(rig.device->faults(), kDeviceLost);
    DeviceState last;
    ASSERT_TRUE(rig.device->receive(last));
    EXPECT_EQ(last.faults, kDeviceLost);
    EXPECT_EQ(last.sequence, rig.reading.sequence + 3);  // what came since the last tick
    EXPECT_EQ(model.mode(), protocol::Mode::idle);
  }
  OpenRig again(model, clock);
  ASSERT_FALSE(again.begin());
  EXPECT_GT(again.force_periods_in(50 * kMs, [&] { again.push(3.0); }), 40 * kPeriodsPerMs);
}

TEST(StreamedDevice, unplugging_in_every_phase_of_the_start_is_a_problem_not_a_hang) {
  for (const double at_s : {0.0, 1e-9, 1e-4, 2e-4, 3e-4, 1e-3}) {
    VirtualClock clock;
    OpenDevice model({});
    OpenRig rig(model, clock, out_faults({{FaultKind::unplug, at_s, 100, 0, 1}}));
    const auto problem = rig.begin();
    if (problem) {
      EXPECT_FALSE(problem->phase.empty());
    } else {
      rig.run(100 * kMs, [] {});
      EXPECT_EQ(rig.device->faults(), kDeviceLost);
    }
  }
}

TEST(StreamedDevice, command_that_is_no_number_renders_nothing_and_is_a_fault) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(50 * kMs, [&] { rig.push(3.0); });
  EXPECT_LE(
      rig.force_periods_in(100 * kMs, [&] { rig.push(std::numeric_limits<double>::quiet_NaN()); }),
      2 * kPeriodsPerMs);
  EXPECT_EQ(rig.device->faults(), kDeviceBadCommand);
  EXPECT_EQ(rig.reading.faults, kDeviceBadCommand);
}

TEST(StreamedDevice, overheated_motor_and_broken_sensor_reach_the_reading) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  model.set_health(protocol::kOverheated);
  rig.run(10 * kMs, [&] { rig.push(1.0); });
  EXPECT_EQ(rig.reading.faults, kDeviceOverheated);
  model.set_health(protocol::kBadSensor);
  rig.run(10 * kMs, [&] { rig.push(1.0); });
  EXPECT_EQ(rig.reading.faults, kDeviceBadReading | kDeviceFailed);
  EXPECT_EQ(norm(model.rendered().force_N), 0.0);
}

TEST(StreamedDevice, homing_is_seen_in_its_readings_and_renders_no_force) {
  VirtualClock clock;
  OpenDevice model({});
  model.set_homing(true);
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  EXPECT_EQ(rig.force_periods_in(50 * kMs, [&] { rig.push(3.0); }), 0u);
  EXPECT_TRUE(rig.reading.homing);
  model.set_homing(false);
  EXPECT_GT(rig.force_periods_in(50 * kMs, [&] { rig.push(3.0); }), 40 * kPeriodsPerMs);
  EXPECT_FALSE(rig.reading.homing);
}

TEST(StreamedDevice, device_that_never_speaks_is_named) {
  VirtualClock clock;
  OpenDevice model({});
  model.set_silent(true);
  OpenRig rig(model, clock);
  const auto problem = rig.begin();
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->cause, "the device sends nothing");
}

/// Answers with what is given instead of its capabilities.
class Impostor final : public OpenDevice {
 public:
  explicit Impostor(IoResult result, protocol::Packet packet = {})
      : OpenDevice({}), result_(result), packet_(packet) {}
  IoResult control_in(const ControlRequest& /*request*/, std::span<std::byte> out) override {
    std::copy_n(packet_.begin(), std::min(out.size(), result_.bytes), out.begin());
    return result_;
  }

 private:
  IoResult result_;
  protocol::Packet packet_;
};

std::string cause_of(Impostor&& model) {
  VirtualClock clock;
  OpenRig rig(model, clock);
  const auto problem = rig.device->open();
  EXPECT_TRUE(problem);
  EXPECT_EQ(problem ? problem->phase : "", "descriptors");
  return problem ? problem->cause : "";
}

TEST(StreamedDevice, wrong_descriptors_are_refused_with_the_reason) {
  protocol::Packet other_version = protocol::encode(OpenDeviceOptions::default_capabilities());
  other_version[2] = std::byte{2};
  EXPECT_EQ(cause_of(Impostor({IoStatus::ok, 64}, other_version)),
            "the device speaks version 2 of the protocol, this host version 1");
  EXPECT_EQ(cause_of(Impostor({IoStatus::ok, 0})), "its answer is refused, wrong size");
  EXPECT_EQ(cause_of(Impostor({IoStatus::ok, 64})),
            "its answer is refused, not a packet of this protocol");
  EXPECT_EQ(cause_of(Impostor({IoStatus::stalled})), "refused by the device");
  EXPECT_EQ(cause_of(Impostor({IoStatus::timed_out})), "no answer in time");
  // Asked for a joint it answers with its capabilities again.
  protocol::Capabilities joints = OpenDeviceOptions::default_capabilities();
  joints.joints = 6;
  EXPECT_EQ(cause_of(Impostor({IoStatus::ok, 64}, protocol::encode(joints))),
            "its answer is refused, another type of packet");
}

TEST(StreamedDevice, start_before_open_is_refused) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  EXPECT_TRUE(rig.device->start());
}

TEST(StreamedDevice, drifting_device_clocks_keep_readings_young) {
  for (const double drift : {-4e-4, 4e-4}) {
    VirtualClock clock;
    OpenDeviceOptions options;
    options.sensor_faults = mock::Faults({{FaultKind::drift, 0, 1000, drift, 1}}, 1);
    OpenDevice model(options);
    OpenRig rig(model, clock);
    ASSERT_FALSE(rig.begin());
    std::uint64_t oldest_ns = 0;
    rig.run(20'000 * kMs, [&] {
      rig.push(1.0);
      oldest_ns = std::max(oldest_ns, clock.now_ns() - rig.reading.time_ns);
    });
    EXPECT_LE(oldest_ns, kMs);
    EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
  }
}

// Every kind of fault on both ways at once, in bursts and all the time.
TEST(StreamedDevice, bad_lines_give_no_torn_reading_and_no_force_beyond_its_life) {
  for (const double share : {0.02, 0.3}) {
    std::vector<FaultWindow> script;
    for (const FaultKind kind :
         {FaultKind::drop, FaultKind::repeat, FaultKind::reorder, FaultKind::truncate}) {
      script.push_back({kind, 0.05, 100, 7, share});
    }
    script.push_back({FaultKind::corrupt, 0.05, 100, 2, share});
    script.push_back({FaultKind::delay, 0.05, 100, 0.003, share});
    VirtualClock clock;
    OpenDevice model({});
    OpenRig rig(model, clock, {{script, 5}, {script, 6}});
    ASSERT_FALSE(rig.begin());
    DeviceState last;
    rig.run(10'000 * kMs, [&] {
      rig.push(3.0);
      const DeviceState& s = rig.reading;
      ASSERT_GE(s.sequence, last.sequence);
      ASSERT_GE(s.time_ns, last.time_ns);
      ASSERT_LE(s.time_ns, clock.now_ns());
      ASSERT_LT(std::abs(s.pose.position_m.x), 0.02);
      ASSERT_EQ(s.pose.position_m.y, 0.0);
      last = s;
    });
    rig.run(100 * kMs, [] {});
    EXPECT_EQ(norm(model.rendered().force_N), 0.0);
    EXPECT_GT(last.sequence, 30'000u * (share < 0.1 ? 1 : 0));
  }
}

TEST(StreamedDevice, million_exchanges_lose_nothing) {
  VirtualClock clock;
  OpenDevice model({});
  OpenRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  std::uint64_t seen = 0, lost = 0, oldest_ns = 0, before = 0;
  while (seen < 1'000'000) {
    ASSERT_TRUE(rig.device->step());
    if (!rig.device->receive(rig.reading)) continue;
    lost += before == 0 ? 0 : rig.reading.sequence - before - 1;
    before = rig.reading.sequence;
    oldest_ns = std::max(oldest_ns, clock.now_ns() - rig.reading.time_ns);
    ++seen;
    rig.push(0.5);
  }
  EXPECT_EQ(lost, 0u);
  EXPECT_LE(oldest_ns, kMs / 4);
  EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
}

// With its thread, on the real clock: readings whole and in order on the other side.
TEST(StreamedDevice, thread_hands_over_whole_readings) {
  MonotonicClock clock;
  OpenDeviceOptions options;
  options.hand.script = {{0, {}}, {1, {{1, 2, -1}, {}}}};
  options.hand.grip_N_per_m = 0;  // it moves with the damper alone, along one line
  OpenDevice model(options);
  SimulatedRig rig(model, clock, std::make_unique<protocol::HostDriver>(), {}, true);
  ASSERT_FALSE(rig.begin());
  std::uint64_t readings = 0;
  const std::uint64_t end_ns = clock.now_ns() + 300 * kMs;
  while (clock.now_ns() < end_ns) {
    const std::uint64_t before = rig.reading.sequence;
    rig.push(0.0);
    if (rig.reading.sequence == before) {
      std::this_thread::yield();
      continue;
    }
    ++readings;
    ASSERT_GT(rig.reading.sequence, before);
    const Vec3d& p = rig.reading.pose.position_m;
    ASSERT_NEAR(p.y, 2 * p.x, 3e-9);
    ASSERT_NEAR(p.z, -p.x, 3e-9);
  }
  rig.device->stop();
  EXPECT_GT(readings, 10u);
}

}  // namespace
}  // namespace palpate::hal
