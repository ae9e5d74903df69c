// SPDX-License-Identifier: GPL-3.0-or-later
// Every state of the safety stage, and every fault in each of them.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/virtual_loop.hpp"
#include "tools/realtime/safety.hpp"

namespace palpate::realtime {
namespace {

constexpr double kStagePeriod_s = 1e-3;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// What one tick is given.
struct Tick {
  bool connected = true;
  hal::DeviceState reading;
  double age_s = 0;
  Status status = Status::ok;
  Wrench rendered{{0, 0, 2}, {0.05, 0, 0}};
  std::uint64_t missed = 0;
};

SafetySettings quick() {
  SafetySettings settings;
  settings.connect_within_s = 0.1;
  settings.home_within_s = 0.03;
  settings.arm_ticks = 10;
  settings.start_ramp_s = 0.01;
  settings.late_ticks_to_fault = 4;
  return settings;
}

struct Stage {
  SafetyStage stage{quick(), kStagePeriod_s};
  /// The wrench of the last of so many ticks.
  Wrench run(const Tick& tick, int count = 1) {
    Wrench sent;
    for (int i = 0; i < count; ++i) {
      static_cast<void>(stage.accept(tick.connected ? &tick.reading : nullptr, tick.age_s));
      sent = stage.command(tick.status, tick.rendered, {});
      stage.tick_ended(tick.missed);
    }
    return sent;
  }
};

Tick nobody_there() {
  Tick tick;
  tick.connected = false;
  return tick;
}

Tick homing() {
  Tick tick;
  tick.reading.homing = true;
  return tick;
}

/// A stage in a state, and what keeps it there for a few ticks.
struct Held {
  Stage stage;
  Tick tick;
};

Held held_in(LoopState state) {
  Held held;
  if (state == LoopState::disconnected) held.tick = nobody_there();
  if (state == LoopState::homing) held.tick = homing();
  held.stage.run(held.tick, state == LoopState::rendering ? 100 : 2);
  if (state == LoopState::fault) {
    Tick lost;
    lost.reading.faults = hal::kDeviceLost;
    held.stage.run(lost);
  }
  return held;
}

constexpr LoopState kStates[] = {LoopState::disconnected, LoopState::homing, LoopState::armed,
                                 LoopState::rendering, LoopState::fault};

TEST(LoopStates, force_is_rendered_in_one_of_them_only) {
  for (const LoopState state : kStates) {
    Held held = held_in(state);
    ASSERT_EQ(held.stage.stage.state(), state) << name(state);
    if (state == LoopState::fault) held.stage.run(held.tick);  // the ramp down
    const Wrench sent = held.stage.run(held.tick, 3);
    EXPECT_EQ(norm(sent.force_N) > 0, state == LoopState::rendering) << name(state);
    EXPECT_EQ(norm(sent.torque_Nm) > 0, state == LoopState::rendering) << name(state);
  }
}

TEST(LoopStates, follow_each_other_from_disconnected_to_rendering) {
  Stage s;
  EXPECT_EQ(s.stage.state(), LoopState::disconnected);
  s.run(nobody_there(), 5);
  EXPECT_EQ(s.stage.state(), LoopState::disconnected);
  s.run(homing(), 25);
  EXPECT_EQ(s.stage.state(), LoopState::homing);
  s.run({});
  EXPECT_EQ(s.stage.state(), LoopState::armed);
  s.run({}, 12);
  EXPECT_EQ(s.stage.state(), LoopState::rendering);
  EXPECT_TRUE(s.stage.faults().empty());
}

TEST(LoopStates, device_that_need_not_home_is_armed_at_once) {
  Stage s;
  s.run({});
  EXPECT_EQ(s.stage.state(), LoopState::armed);
}

TEST(LoopStates, contacts_are_asked_only_once_the_pose_means_something) {
  for (const LoopState state : kStates) {
    Held held = held_in(state);
    const hal::DeviceState& reading = held.tick.reading;
    const bool asked = held.stage.stage.accept(held.tick.connected ? &reading : nullptr, 0);
    EXPECT_EQ(asked, state == LoopState::armed || state == LoopState::rendering) << name(state);
  }
}

/// Something that goes wrong.
struct Doubt {
  Fault fault;
  std::function<void(Tick&)> spoil;
  int ticks;          ///< until it is a fault, at most
  bool of_reading;    ///< seen wherever there are readings, not only where contacts are asked
  bool of_the_clock;  ///< seen everywhere
};

const Doubt kDoubts[] = {
    {Fault::stale_state, [](Tick& t) { t.age_s = 1; }, 1, true, false},
    {Fault::bad_state, [](Tick& t) { t.reading.pose.position_m.y = kNoNumber; }, 1, true, false},
    {Fault::missed_deadlines, [](Tick& t) { t.missed = 1; }, 4, true, true},
    {Fault::engine_error, [](Tick& t) { t.status = Status::bad_pose; }, 1, false, false},
    {Fault::bad_wrench, [](Tick& t) { t.rendered.torque_Nm.x = kNoNumber; }, 1, false, false},
    {Fault::device_error, [](Tick& t) { t.reading.faults = hal::kDeviceFailed; }, 1, true, false},
    {Fault::not_homed, [](Tick& t) { t.reading.homing = true; }, 31, true, false},
};

bool is_seen(const Doubt& doubt, LoopState state) {
  if (state == LoopState::armed || state == LoopState::rendering) return true;
  return state == LoopState::disconnected ? doubt.of_the_clock : doubt.of_reading;
}

TEST(LoopStates, every_fault_ends_every_state_that_it_can_be_seen_in) {
  static_assert(std::size(kDoubts) == kFaultCount);
  for (const Doubt& doubt : kDoubts) {
    for (const LoopState state : kStates) {
      SCOPED_TRACE(std::string(name(doubt.fault)) + " while " + std::string(name(state)));
      Held held = held_in(state);
      doubt.spoil(held.tick);
      held.stage.run(held.tick, doubt.ticks);
      const bool seen = is_seen(doubt, state);
      EXPECT_EQ(held.stage.stage.faults().has(doubt.fault), seen);
      EXPECT_EQ(held.stage.stage.state(), seen ? LoopState::fault : state);
      EXPECT_EQ(norm(held.stage.run(held.tick, 2).force_N), 0.0);
    }
  }
}

TEST(LoopStates, numbers_of_faults_are_those_of_the_trace_format) {
  constexpr const char* kNames[] = {"stale_state",  "bad_state",  "missed_deadlines",
                                    "engine_error", "bad_wrench", "device_error",
                                    "not_homed"};
  for (std::uint8_t i = 0; i < kFaultCount; ++i) {
    FaultSet set;
    set.add(Fault{i});
    EXPECT_EQ(set.bits, 1u << i);
    EXPECT_EQ(names(set), std::vector<std::string_view>{kNames[i]});
  }
}

TEST(HomingLoop, sends_no_force_until_the_device_knows_its_zero) {
  hal::mock::HandParameters hand;
  hand.rest.position_m.z = -0.005;  // in the wall all the while
  hal::mock::Options options = test::VirtualLoop::virtual_time(2000);
  options.homing_s = 0.3;
  LoopSettings settings;
  settings.periods = 1000;
  test::VirtualLoop rig(hand, settings, test::wall(600), 1u << 14, options);
  const LoopReport& r = rig.run();
  EXPECT_EQ(r.state, LoopState::rendering);
  EXPECT_NEAR(static_cast<double>(r.homing), 300, 2);
  EXPECT_EQ(r.ticks, 1000 + r.homing);
  const std::vector<TraceRecord> records = rig.records();
  ASSERT_EQ(records.size(), r.ticks);
  for (std::size_t i = 0; i < r.homing; ++i) {
    EXPECT_EQ(records[i].state, static_cast<std::uint8_t>(LoopState::homing));
    EXPECT_EQ(records[i].contacts, 0u);
    EXPECT_EQ(records[i].sent_force_N[2], 0.0F);
  }
  EXPECT_GT(records.back().sent_force_N[2], 0.5F);
}

}  // namespace
}  // namespace palpate::realtime
