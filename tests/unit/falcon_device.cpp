// SPDX-License-Identifier: Apache-2.0
// Bring-up and driver of the Falcon against the model of one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "../support/simulated_rig.hpp"
#include "hal/falcon/bring_up.hpp"
#include "hal/falcon/driver.hpp"
#include "hal/falcon/ftdi.hpp"
#include "hal/simulator/falcon_device.hpp"

namespace palpate::hal::falcon {
namespace {

using namespace hal::test;
using mock::FaultKind;
using simulator::FalconDevice;
using simulator::FalconDeviceOptions;
using simulator::Port;
using simulator::PortFaults;

std::vector<std::byte> some_firmware(std::size_t bytes = 7914) {
  std::vector<std::byte> out(bytes);
  for (std::size_t i = 0; i < bytes; ++i) out[i] = static_cast<std::byte>(i * 7 + i / 256);
  return out;
}

std::optional<DeviceProblem> bring_up_of(FalconDevice& model, std::size_t firmware_bytes = 7914,
                                         PortFaults faults = {}) {
  VirtualClock clock;
  Port port(model, clock, std::move(faults));
  return bring_up(port, some_firmware(firmware_bytes));
}

TEST(Ftdi, status_bytes_of_every_packet_are_removed) {
  std::array<std::byte, 130> transfer;
  for (std::size_t i = 0; i < transfer.size(); ++i) transfer[i] = static_cast<std::byte>(i);
  ASSERT_EQ(strip_status(transfer), 62u + 62u);  // two packets and one that is only status
  EXPECT_EQ(transfer[0], std::byte{2});
  EXPECT_EQ(transfer[61], std::byte{63});
  EXPECT_EQ(transfer[62], std::byte{66});
  EXPECT_EQ(transfer[123], std::byte{127});
  EXPECT_EQ(strip_status(std::span(transfer).first(0)), 0u);
  EXPECT_EQ(strip_status(std::span(transfer).first(1)), 0u);
  EXPECT_EQ(strip_status(std::span(transfer).first(2)), 0u);
}

TEST(FalconBringUp, firmware_is_uploaded_byte_for_byte) {
  FalconDevice model({});
  EXPECT_FALSE(bring_up_of(model));
  EXPECT_EQ(model.uploaded(), some_firmware());
}

TEST(FalconBringUp, running_firmware_is_left_alone) {
  FalconDeviceOptions options;
  options.firmware_runs = true;
  FalconDevice model(options);
  EXPECT_FALSE(bring_up_of(model, 0));
  EXPECT_TRUE(model.uploaded().empty());
}

TEST(FalconBringUp, missing_firmware_is_named) {
  FalconDevice model({});
  const auto problem = bring_up_of(model, 0);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "probe");
  EXPECT_NE(problem->fix.find("--firmware"), std::string::npos);
}

TEST(FalconBringUp, file_that_can_be_no_firmware_is_not_uploaded) {
  for (const std::size_t bytes : {10u, 100'000u}) {
    FalconDevice model({});
    const auto problem = bring_up_of(model, bytes);
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->phase, "upload");
    EXPECT_TRUE(model.uploaded().empty());
  }
}

TEST(FalconBringUp, every_length_is_uploaded_whole) {
  for (std::size_t bytes = 1024; bytes < 1024 + 130; ++bytes) {
    FalconDevice model({});
    ASSERT_FALSE(bring_up_of(model, bytes));
    ASSERT_EQ(model.uploaded(), some_firmware(bytes));
  }
}

TEST(FalconBringUp, loader_that_wakes_up_late_is_waited_for) {
  FalconDeviceOptions options;
  options.deaf_to_hellos = 99;
  options.zero_before_hello = true;
  FalconDevice model(options);
  EXPECT_FALSE(bring_up_of(model));
}

TEST(FalconBringUp, loader_that_never_answers_is_given_up_after_bounded_tries) {
  FalconDeviceOptions options;
  options.deaf_to_hellos = 1'000'000;
  FalconDevice model(options);
  const auto problem = bring_up_of(model);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "hello");
  EXPECT_EQ(problem->cause, "the loader does not answer (3 attempts)");
}

TEST(FalconBringUp, changed_echo_is_noticed_and_the_upload_repeated) {
  FalconDeviceOptions options;
  options.bad_uploads = 2;
  FalconDevice model(options);
  EXPECT_FALSE(bring_up_of(model));
  EXPECT_EQ(model.uploaded(), some_firmware());
}

TEST(FalconBringUp, echo_that_stays_wrong_names_the_byte) {
  FalconDeviceOptions options;
  options.bad_uploads = 3;
  FalconDevice model(options);
  const auto problem = bring_up_of(model);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "upload");
  EXPECT_EQ(problem->cause, "byte 557 of 7914 came back changed (3 attempts)");
}

TEST(FalconBringUp, bytes_that_do_not_run_are_named) {
  FalconDeviceOptions options;
  options.runs_what_it_got = false;
  FalconDevice model(options);
  const auto problem = bring_up_of(model);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->phase, "run");
}

TEST(FalconBringUp, latency_timer_that_stays_at_16_ms_is_noticed) {
  FalconDeviceOptions options;
  options.firmware_runs = true;
  options.ignores_latency = true;
  FalconDevice model(options);
  const auto problem = bring_up_of(model, 0);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->cause, "latency timer: the transfer failed");
}

TEST(FalconBringUp, unplugging_at_any_time_is_a_problem_not_a_hang) {
  for (double at_s = 0; at_s < 0.5; at_s += 0.002) {
    FalconDevice model({});
    const auto problem =
        bring_up_of(model, 7914, {mock::Faults({{FaultKind::unplug, at_s, 1e9, 0, 1}}, 1), {}});
    if (problem) {
      EXPECT_EQ(problem->cause.substr(0, 18), "the device is gone") << problem->cause;
    }
  }
}

TEST(FalconBringUp, lossy_line_ends_in_a_named_phase_or_in_a_whole_upload) {
  int brought_up = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    FalconDevice model({});
    const mock::Faults faults({{FaultKind::drop, 0, 1e9, 0, 0.002},
                               {FaultKind::corrupt, 0, 1e9, 1, 0.002},
                               {FaultKind::repeat, 0, 1e9, 1, 0.002}},
                              seed);
    const auto problem = bring_up_of(model, 7914, {faults, {}});
    if (problem) {
      EXPECT_FALSE(problem->phase.empty());
    } else {
      ++brought_up;
      EXPECT_EQ(model.uploaded(), some_firmware());
    }
  }
  EXPECT_GT(brought_up, 100);
}

struct FalconRig : SimulatedRig {
  explicit FalconRig(FalconDevice& a_model, Clock& a_clock, PortFaults faults = {})
      : SimulatedRig(a_model, a_clock, std::make_unique<FalconDriver>(some_firmware()),
                     std::move(faults)),
        model(a_model) {}
  /// Begins, and waits until it is homed.
  [[nodiscard]] std::optional<DeviceProblem> begin_homed() {
    auto problem = begin();
    for (int ms = 0; !problem && ms < 1000 && (ms == 0 || reading.homing); ++ms) {
      run(kMs, [&] { push(0); });
    }
    return problem;
  }
  FalconDevice& model;
};

bool has_force(const FalconDevice& model) { return model.motors() != MotorValues{}; }

TEST(FalconDriver, readings_have_a_pose_after_homing_and_motors_stay_off_before) {
  VirtualClock clock;
  FalconDevice model({});
  FalconRig rig(model, clock);
  ASSERT_FALSE(rig.begin());
  rig.run(400 * kMs, [&] {
    rig.push(5);  // somebody pushes already
    EXPECT_TRUE(rig.reading.homing);
    EXPECT_EQ(norm(rig.reading.pose.position_m), 0.0);
    EXPECT_FALSE(has_force(model));
  });
  EXPECT_GT(rig.reading.sequence, 200u);
  rig.run(200 * kMs, [&] { rig.push(0); });
  EXPECT_FALSE(rig.reading.homing);
  EXPECT_LT(norm(rig.reading.pose.position_m - model.position_m()), 1e-4);
}

TEST(FalconDriver, force_pushes_the_grip_where_it_points) {
  for (const Vec3d& force : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}, Vec3d{1, 1, -1}}) {
    VirtualClock clock;
    FalconDevice model({});
    FalconRig rig(model, clock);
    ASSERT_FALSE(rig.begin_homed());
    rig.run(1500 * kMs, [&] {
      rig.push(0);
      rig.command.wrench.force_N = force;
      rig.device->send(rig.command);
    });
    const double stiffness = mock::HandParameters{}.grip_N_per_m;
    EXPECT_LT(norm(stiffness * rig.reading.pose.position_m - force), 0.05);
    EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
    EXPECT_GT(rig.reading.sequence, 700u);  // at the bridge's 1 ms
  }
}

TEST(FalconDriver, motors_are_never_beyond_their_limit) {
  VirtualClock clock;
  FalconDevice model({});
  FalconRig rig(model, clock);
  ASSERT_FALSE(rig.begin_homed());
  rig.run(200 * kMs, [&] {
    rig.push(1e6);
    for (const std::int16_t m : model.motors()) ASSERT_LE(std::abs(m), kMaxMotorValue);
  });
  EXPECT_TRUE(has_force(model));
}

TEST(FalconDriver, silent_loop_leaves_no_force) {
  VirtualClock clock;
  FalconDevice model({});
  FalconRig rig(model, clock);
  ASSERT_FALSE(rig.begin_homed());
  rig.run(100 * kMs, [&] { rig.push(2); });
  ASSERT_TRUE(has_force(model));
  rig.run(kCommandLife_ns + 3 * kMs, [] {});
  EXPECT_FALSE(has_force(model));
  EXPECT_EQ(rig.device->faults(), kDeviceSilenced);
}

TEST(FalconDriver, stop_turns_the_motors_off) {
  VirtualClock clock;
  FalconDevice model({});
  FalconRig rig(model, clock);
  ASSERT_FALSE(rig.begin_homed());
  rig.run(100 * kMs, [&] { rig.push(2); });
  rig.device->stop();
  EXPECT_FALSE(has_force(model));
}

TEST(FalconDriver, mute_firmware_is_asked_again_and_then_given_up) {
  VirtualClock clock;
  FalconDevice model({});
  FalconRig rig(model, clock);
  ASSERT_FALSE(rig.begin_homed());
  rig.run(100 * kMs, [&] { rig.push(2); });
  model.set_mute(true);
  rig.run(100 * kMs, [&] { rig.push(2); });
  EXPECT_EQ(rig.device->faults(), kNoDeviceFault);
  model.set_mute(false);
  rig.run(100 * kMs, [&] { rig.push(2); });
  EXPECT_LT(clock.now_ns() - rig.reading.time_ns, 3 * kMs);
  model.set_mute(true);
  rig.run(300 * kMs, [&] { rig.push(2); });
  EXPECT_EQ(rig.device->faults(), kDeviceLost);
}

TEST(FalconDriver, short_replies_are_never_taken_for_readings) {
  VirtualClock clock;
  FalconDevice model({});
  FalconRig rig(model, clock);
  ASSERT_FALSE(rig.begin_homed());
  rig.run(100 * kMs, [&] { rig.push(0); });
  const std::uint64_t before = rig.reading.sequence;
  model.shorten_replies(2);
  rig.run(100 * kMs, [&] { rig.push(0); });
  EXPECT_LE(rig.reading.sequence, before + 8);  // gaps of requests given up, no reading
  EXPECT_GT(clock.now_ns() - rig.reading.time_ns, 90 * kMs);
}

TEST(FalconDriver, lost_zero_ends_the_force_and_is_a_fault) {
  VirtualClock clock;
  FalconDevice model({});
  FalconRig rig(model, clock);
  ASSERT_FALSE(rig.begin_homed());
  rig.run(100 * kMs, [&] { rig.push(2); });
  model.forget_zero();
  rig.run(20 * kMs, [&] { rig.push(2); });
  EXPECT_FALSE(has_force(model));
  EXPECT_EQ(rig.device->faults(), kDeviceBadReading);
}

TEST(FalconDriver, bad_line_gives_no_wrong_reading) {
  VirtualClock clock;
  FalconDevice model({});
  std::vector<mock::FaultWindow> script;
  for (const FaultKind kind : {FaultKind::drop, FaultKind::repeat, FaultKind::reorder}) {
    script.push_back({kind, 2, 100, 0, 0.02});
  }
  script.push_back({FaultKind::truncate, 2, 100, 5, 0.02});
  FalconRig rig(model, clock, {{script, 1}, {script, 2}});
  ASSERT_FALSE(rig.begin_homed());
  std::uint64_t last = 0, readings = 0;
  rig.run(20'000 * kMs, [&] {
    rig.push(1);
    ASSERT_LT(norm(rig.reading.pose.position_m - model.position_m()), 2e-3);
    if (rig.reading.sequence != last) ++readings;
    last = rig.reading.sequence;
  });
  EXPECT_GT(readings, 3000u);
}

}  // namespace
}  // namespace palpate::hal::falcon
