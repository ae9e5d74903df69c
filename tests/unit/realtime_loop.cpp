// SPDX-License-Identifier: GPL-3.0-or-later
// The loop's timing, accounting and faults, in virtual time.
#include "tools/realtime/loop.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/virtual_loop.hpp"

namespace palpate::realtime {
namespace {

using test::VirtualLoop;
using test::wall;

constexpr std::uint64_t kPeriod_ns = 1'000'000;

LoopSettings for_periods(std::uint64_t periods) {
  LoopSettings settings;
  settings.periods = periods;
  settings.safety.arm_ticks = 10;
  return settings;
}

/// A loop whose contact query spends time: how much is a function of the tick.
struct BusyLoop {
  explicit BusyLoop(const LoopSettings& settings,
                    std::function<std::uint64_t(std::uint64_t)> cost_ns)
      : rig({}, settings, [this, cost_ns](const Pose&, const Budget& budget, TickResult& out) {
          out = {};
          allowed_ns.push_back(budget.deadline_ns - budget.clock_ns(budget.clock_context));
          reserve_ns.push_back(budget.reserve_ns);
          rig.clock.spend(cost_ns(queries++));
          return Status::ok;
        }) {}
  std::uint64_t queries = 0;
  std::vector<std::uint64_t> allowed_ns, reserve_ns;
  VirtualLoop rig;
};

TEST(Loop, quick_ticks_miss_nothing) {
  VirtualLoop rig({}, for_periods(500), wall(600));
  const LoopReport& r = rig.run();
  EXPECT_EQ(r.ticks, 500u);
  EXPECT_EQ(r.missed, 0u);
  EXPECT_EQ(r.overrun_ns_max, 0u);
  EXPECT_EQ(r.latency.max_ns(), 0u);
  EXPECT_EQ(r.state, LoopState::rendering);
  EXPECT_TRUE(r.faults.empty());
  EXPECT_EQ(rig.loop.periods_passed(), 500u);
}

TEST(Loop, late_tick_skips_the_periods_it_ran_into_and_keeps_the_grid) {
  BusyLoop busy(for_periods(100),
                [](std::uint64_t n) { return n == 20 ? 5 * kPeriod_ns / 2 : 1000; });
  const LoopReport& r = busy.rig.run();
  EXPECT_EQ(r.missed, 2u);
  EXPECT_EQ(r.ticks + r.missed, 100u);
  EXPECT_EQ(r.overrun_ns_max, 3 * kPeriod_ns / 2);
  EXPECT_EQ(r.tick.max_ns(), 5 * kPeriod_ns / 2);
  const auto records = busy.rig.records();
  ASSERT_EQ(records.size(), r.ticks);
  EXPECT_EQ(records[20].time_ns, 20 * kPeriod_ns);
  EXPECT_EQ(records[21].time_ns, 23 * kPeriod_ns);
  EXPECT_EQ(records[21].latency_ns, 0u);
  EXPECT_TRUE(r.faults.empty());
}

TEST(Loop, tick_that_ends_with_its_period_is_late_and_one_before_is_not) {
  EXPECT_EQ(
      BusyLoop(for_periods(50), [](std::uint64_t) { return kPeriod_ns - 1; }).rig.run().missed, 0u);
  const auto once = [](std::uint64_t n) { return n == 5 ? kPeriod_ns : std::uint64_t(0); };
  EXPECT_EQ(BusyLoop(for_periods(50), once).rig.run().missed, 1u);
}

TEST(Loop, always_late_ends_in_a_fault_with_zero_force) {
  BusyLoop busy(for_periods(200), [](std::uint64_t) { return 3 * kPeriod_ns / 2; });
  const LoopReport& r = busy.rig.run();
  EXPECT_EQ(r.state, LoopState::fault);
  EXPECT_TRUE(r.faults.has(Fault::missed_deadlines));
  EXPECT_EQ(busy.queries, 10u);  // in fault the engine is not asked
}

TEST(Loop, query_gets_the_budget_or_what_is_left_of_its_share_of_the_period) {
  LoopSettings settings = for_periods(20);
  settings.query_time.budget_us = 400;
  BusyLoop budgeted(settings, [](std::uint64_t) { return 0; });
  budgeted.rig.run();
  EXPECT_EQ(budgeted.allowed_ns.at(5), 400'000u);

  settings.query_time.budget_us = 5000;
  BusyLoop bounded(settings, [](std::uint64_t) { return 0; });
  bounded.rig.run();
  EXPECT_EQ(bounded.allowed_ns.at(5), 800'000u);

  settings.query_time.budget_us.reset();
  BusyLoop unbudgeted(settings, [](std::uint64_t) { return 0; });
  unbudgeted.rig.run();
  EXPECT_EQ(unbudgeted.allowed_ns.at(5), 800'000u);
}

TEST(Loop, query_has_the_rest_of_that_share_in_reserve_unless_it_is_given_less) {
  const auto reserve = [](std::optional<double> budget_us, std::optional<double> reserve_us) {
    LoopSettings settings = for_periods(20);
    settings.query_time = {budget_us, reserve_us};
    BusyLoop busy(settings, [](std::uint64_t) { return 0; });
    busy.rig.run();
    return busy.reserve_ns.at(5);
  };
  EXPECT_EQ(reserve(300, {}), 500'000u);
  EXPECT_EQ(reserve(300, 100), 100'000u);
  EXPECT_EQ(reserve(300, 0), 0u);
  EXPECT_EQ(reserve(300, 1e9), 500'000u);
  EXPECT_EQ(reserve(5000, 100), 0u);
  EXPECT_EQ(reserve({}, {}), 0u);
}

TEST(Loop, stop_flag_ends_the_run_with_a_command_of_zero) {
  hal::mock::HandParameters hand;
  hand.rest.position_m.z = -0.005;
  VirtualLoop* rig_of_query = nullptr;
  std::uint64_t queries = 0;
  LoopSettings settings = for_periods(std::numeric_limits<std::uint64_t>::max());
  VirtualLoop rig(hand, settings, [&](const Pose& tool, const Budget& b, TickResult& out) {
    if (++queries == 1000) rig_of_query->stop = true;
    return wall(600)(tool, b, out);
  });
  rig_of_query = &rig;
  const LoopReport& r = rig.run();
  EXPECT_EQ(r.ticks, 1000u);
  EXPECT_GT(r.force_N_max, 0.5);
  // The hand goes back to where its grip wants it: nothing pushes any more.
  rig.clock.spend(3'000'000'000);
  hal::DeviceState state;
  ASSERT_TRUE(rig.device.receive(state));
  EXPECT_NEAR(state.pose.position_m.z, -0.005, 1e-6);
}

TEST(Loop, device_that_falls_silent_is_a_stale_state) {
  VirtualLoop* rig_of_query = nullptr;
  std::uint64_t queries = 0;
  VirtualLoop rig({}, for_periods(1000), [&](const Pose& tool, const Budget& b, TickResult& out) {
    if (++queries == 500) rig_of_query->clock.kill_device();
    return wall(600)(tool, b, out);
  });
  rig_of_query = &rig;
  const LoopReport& r = rig.run();
  EXPECT_EQ(r.state, LoopState::fault);
  EXPECT_TRUE(r.faults.has(Fault::stale_state));
  EXPECT_NEAR(static_cast<double>(queries), 550, 2);  // 50 ms after the last reading
}

TEST(Loop, engine_error_is_a_fault_and_names_itself) {
  std::uint64_t queries = 0;
  VirtualLoop rig({}, for_periods(1000), [&](const Pose&, const Budget&, TickResult&) {
    return ++queries < 300 ? Status::ok : Status::bad_pose;
  });
  const LoopReport& r = rig.run();
  EXPECT_EQ(queries, 300u);
  EXPECT_TRUE(r.faults.has(Fault::engine_error));
}

TEST(Loop, certificates_and_contacts_are_counted) {
  static const Contact kContacts[3] = {};
  std::uint64_t queries = 0;
  VirtualLoop rig({}, for_periods(100), [&](const Pose&, const Budget&, TickResult& out) {
    out = {};
    out.certificate.truncated_by_time = ++queries % 4 == 0;
    out.certificate.on_reserve = queries % 5 == 0;
    out.contacts = kContacts;
    return Status::ok;
  });
  const LoopReport& r = rig.run();
  EXPECT_EQ(r.queried, 100u);
  EXPECT_EQ(r.truncated, 25u);
  EXPECT_EQ(r.on_reserve, 20u);
  EXPECT_EQ(r.contacts, 300u);
  EXPECT_EQ(r.touching, 100u);
  EXPECT_EQ(rig.records().at(3).truncated, kByTime);
}

TEST(Loop, full_ring_drops_records_and_never_holds_the_loop) {
  VirtualLoop rig({}, for_periods(100), wall(600), 16);
  const LoopReport& r = rig.run();
  EXPECT_EQ(r.ticks, 100u);
  EXPECT_EQ(rig.ring.dropped(), 84u);
}

TEST(Loop, virtual_time_counts_no_allocation_of_its_own) {
  VirtualLoop rig({}, for_periods(1000), wall(600));
  const LoopReport& r = rig.run();
  EXPECT_EQ(r.counted.allocator_calls.value_or(0), 0u);
}

TEST(Loop, reading_age_is_the_time_since_the_device_took_it) {
  // The device reads at 2 kHz from 1 ns on, the loop wakes 1 ns + n ms after the start: both on one
  // grid.
  VirtualLoop rig({}, for_periods(100), wall(600));
  EXPECT_EQ(rig.run().state_age.max_ns(), 0u);
}

}  // namespace
}  // namespace palpate::realtime
