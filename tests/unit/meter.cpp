// SPDX-License-Identifier: Apache-2.0
// A meter on a clock that a test sets.
#include "rt_core/base/meter.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace palpate {
namespace {

constexpr std::uint64_t kDeadline_ns = 1'000'000;

struct SetClock {
  std::uint64_t now_ns = 0;

  static std::uint64_t read(void* self) { return static_cast<SetClock*>(self)->now_ns; }
  Budget budget() { return {.clock_ns = read, .clock_context = this, .deadline_ns = kDeadline_ns}; }
};

/// When refinement ends on a meter made at time zero, by bisection.
std::uint64_t end_ns(const Meter& meter, SetClock& clock) {
  std::uint64_t low = 0;
  std::uint64_t high = 2 * kDeadline_ns;
  while (high - low > 1) {
    clock.now_ns = (low + high) / 2;
    (meter.out_of_time() ? high : low) = clock.now_ns;
  }
  return high;
}

/// Has seen many tails of ticks with a hundred contacts.
TailTime learnt(std::uint64_t tail_ns) {
  TailTime tail;
  for (int i = 0; i < 100; ++i) tail.learn(tail_ns, 100);
  return tail;
}

/// The first tick has to end in time, too.
TEST(Meter, before_anything_is_learnt_contacts_take_some_time) {
  SetClock clock;
  Meter meter(clock.budget(), {});
  EXPECT_GT(end_ns(meter, clock), kDeadline_ns - kDeadline_ns / 100);
  meter.expect_contacts(500);
  EXPECT_LT(end_ns(meter, clock), kDeadline_ns - kDeadline_ns / 10);
  EXPECT_GE(end_ns(meter, clock), kDeadline_ns / 2);
}

TEST(Meter, tail_of_the_contacts_expected_is_left) {
  constexpr std::uint64_t kTail_ns = 50'000;
  SetClock clock;
  Meter meter(clock.budget(), learnt(kTail_ns));
  EXPECT_GT(end_ns(meter, clock), kDeadline_ns - kTail_ns / 10);
  meter.expect_contacts(100);
  const std::uint64_t end = end_ns(meter, clock);
  EXPECT_LT(end, kDeadline_ns - kTail_ns);
  EXPECT_GT(end, kDeadline_ns - 2 * kTail_ns);
  meter.expect_contacts(20);
  EXPECT_EQ(end_ns(meter, clock), end);
}

TEST(Meter, tail_gets_no_more_than_half) {
  SetClock clock;
  Meter meter(clock.budget(), learnt(kDeadline_ns));
  meter.expect_contacts(1'000'000);
  EXPECT_EQ(end_ns(meter, clock), kDeadline_ns / 2);
}

TEST(Meter, contacts_that_there_is_time_for_are_expected_to_take_half_of_the_budget) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SetClock clock;
  const TailTime tail = learnt(kDeadline_ns);
  const double affordable = Meter(clock.budget(), tail).contacts_affordable();
  for (const int more : {-1, 1}) {
    const auto tail_ns = tail.expected_ns(static_cast<std::uint64_t>(affordable + more));
    EXPECT_EQ(tail_ns > kDeadline_ns / 2, more > 0);
  }
  clock.now_ns = 2 * kDeadline_ns;
  const Meter late(clock.budget(), learnt(kDeadline_ns));
  EXPECT_LT(late.contacts_affordable(), 0);
  clock.now_ns = 0;
  EXPECT_GT(Meter(clock.budget(), {}).contacts_affordable(), 100);
  EXPECT_LT(Meter(clock.budget(), {}).contacts_affordable(), kInfinity);
  EXPECT_EQ(Meter({.units = 1}, learnt(kDeadline_ns)).contacts_affordable(), kInfinity);
}

TEST(Meter, reserve_comes_after_the_budget_once) {
  Meter meter({.units = 100, .reserve_units = 50}, {});
  meter.charge(100);
  EXPECT_TRUE(meter.out_of_units());
  EXPECT_TRUE(meter.has_reserve());
  meter.draw_on_reserve();
  EXPECT_EQ(meter.queries_left(), 50u);
  EXPECT_FALSE(meter.has_reserve());

  SetClock clock;
  Budget budget = clock.budget();
  budget.reserve_ns = kDeadline_ns / 2;
  Meter timed(budget, learnt(50'000));
  timed.expect_contacts(100);
  const std::uint64_t before = end_ns(timed, clock);
  timed.draw_on_reserve();
  EXPECT_EQ(end_ns(timed, clock), before + kDeadline_ns / 2);  // a tail of the same length is left
}

TEST(Meter, reserve_of_what_is_not_limited_is_none) {
  EXPECT_FALSE(Meter({}, {}).has_reserve());
  EXPECT_FALSE(Meter({.units = 5}, {}).has_reserve());
  EXPECT_FALSE(Meter({.units = 5, .reserve_ns = 5}, {}).has_reserve());
  EXPECT_FALSE(Meter({.reserve_units = 5, .reserve_ns = 5}, {}).has_reserve());
  Meter endless({.units = 5, .reserve_units = Budget{}.units}, {});
  endless.charge(1000);
  EXPECT_TRUE(endless.has_reserve());
  endless.draw_on_reserve();
  EXPECT_FALSE(endless.out_of_units());
}

TEST(Meter, reserve_must_be_of_what_has_ended_the_tick) {
  SetClock clock;
  Budget budget = clock.budget();
  budget.units = 5;
  budget.reserve_units = 10;
  Meter of_units(budget, {});
  EXPECT_TRUE(of_units.has_reserve());
  clock.now_ns = kDeadline_ns;
  EXPECT_FALSE(of_units.has_reserve());
  budget.reserve_ns = kDeadline_ns;
  EXPECT_TRUE(Meter(budget, {}).has_reserve());
  budget.reserve_units = 0;
  Meter of_time(budget, {});
  EXPECT_TRUE(of_time.has_reserve());
  of_time.charge(5);
  EXPECT_FALSE(of_time.has_reserve());
}

TEST(Meter, tail_has_three_quarters_of_the_time_that_is_left_for_searches) {
  SetClock clock;
  Meter meter(clock.budget(), learnt(kDeadline_ns / 4));
  meter.expect_contacts(100);
  clock.now_ns = kDeadline_ns / 2;
  meter.begin_tail();
  EXPECT_EQ(end_ns(meter, clock), kDeadline_ns * 7 / 8);
  clock.now_ns = 2 * kDeadline_ns;
  meter.begin_tail();
  EXPECT_TRUE(meter.out_of_time());
}

TEST(Meter, one_interrupted_tail_hardly_counts) {
  TailTime tail = learnt(50'000);
  const std::uint64_t before_ns = tail.expected_ns(100);
  tail.learn(50'000'000, 100);
  EXPECT_LT(tail.expected_ns(100), 3 * before_ns);
}

}  // namespace
}  // namespace palpate
