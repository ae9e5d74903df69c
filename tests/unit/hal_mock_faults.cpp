// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hal/mock/device.hpp"

namespace palpate::hal::mock {
namespace {

constexpr std::uint64_t kMillisecond_ns = 1'000'000;

/// 1 kHz, moving at 1 m/s along x, with faults from 10 ms on.
Options faulty(std::vector<FaultWindow> faults) {
  Options options;
  options.rate_Hz = 1000;
  options.time_base = TimeBase::virtual_;
  options.faults = std::move(faults);
  return options;
}

HandParameters moving_hand() {
  HandParameters hand;
  hand.script = {{0, {}}, {10, {{10, 0, 0}, {}}}};
  return hand;
}

/// Every reading that the host saw, one look a period.
std::vector<DeviceState> readings(const Options& options, std::uint64_t periods = 40) {
  MockDevice device(moving_hand(), options);
  EXPECT_FALSE(device.open());
  std::vector<DeviceState> seen;
  for (std::uint64_t i = 0; i < periods; ++i) {
    device.advance_to((1000 + i) * kMillisecond_ns);
    DeviceState state;
    if (device.receive(state)) seen.push_back(state);
  }
  return seen;
}

std::vector<std::uint64_t> sequences(const std::vector<DeviceState>& states) {
  std::vector<std::uint64_t> out;
  for (const DeviceState& s : states) out.push_back(s.sequence);
  return out;
}

constexpr FaultWindow window(FaultKind kind, double amount = 0, double share = 1) {
  return {kind, 0.0095, 0.005, amount, share};
}

TEST(MockFaults, none_gives_every_reading) {
  EXPECT_EQ(sequences(readings(faulty({}))).size(), 40u);
  EXPECT_EQ(sequences(readings(faulty({{FaultKind::drop, 100, 1, 0, 1}}))).size(), 40u);
}

TEST(MockFaults, dropped_truncated_and_corrupted_readings_do_not_arrive) {
  for (const FaultKind kind : {FaultKind::drop, FaultKind::truncate, FaultKind::corrupt}) {
    const auto seen = readings(faulty({window(kind, 1)}));
    ASSERT_EQ(seen.size(), 35u);
    EXPECT_EQ(seen[9].sequence, 10u);
    EXPECT_EQ(seen[10].sequence, 16u);
  }
}

TEST(MockFaults, delayed_readings_arrive_late_with_their_own_time) {
  const auto seen = readings(faulty({{FaultKind::delay, 0.0095, 1, 0.008, 1}}));
  ASSERT_EQ(seen.size(), 32u);  // nothing for 8 ms
  EXPECT_EQ(seen[9].sequence, 10u);
  EXPECT_EQ(seen[10].sequence, 11u);
  EXPECT_EQ(seen.back().time_ns, (1039 - 8) * kMillisecond_ns);
}

TEST(MockFaults, reading_that_newer_ones_overtake_within_a_period_is_not_seen) {
  const auto seen = sequences(readings(faulty({window(FaultKind::reorder)})));
  EXPECT_TRUE(std::find(seen.begin(), seen.end(), 11u) != seen.end());
  EXPECT_TRUE(std::find(seen.begin(), seen.end(), 12u) == seen.end());
}

TEST(MockFaults, unplugged_device_says_so_once_renders_nothing_and_comes_back) {
  const auto seen = readings(faulty({window(FaultKind::unplug)}));
  ASSERT_EQ(seen.size(), 36u);
  EXPECT_EQ(seen[10].faults, kDeviceLost);
  EXPECT_EQ(seen[11].sequence, 16u);
}

TEST(MockFaults, poses_that_are_no_numbers_arrive_as_they_are) {
  const auto seen = readings(faulty({window(FaultKind::nan)}));
  ASSERT_EQ(seen.size(), 40u);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(std::isnan(seen[i].pose.position_m.x), i >= 10 && i < 15) << i;
  }
}

TEST(MockFaults, stuck_encoder_stands_still_while_time_goes_on) {
  const auto seen = readings(faulty({window(FaultKind::stuck)}));
  EXPECT_EQ(seen[9].pose.position_m.x, seen[14].pose.position_m.x);
  EXPECT_NE(seen[14].pose.position_m.x, seen[15].pose.position_m.x);
  EXPECT_LT(seen[10].time_ns, seen[14].time_ns);
}

TEST(MockFaults, drifting_clock_keeps_what_it_has_gained) {
  const auto seen = readings(faulty({window(FaultKind::drift, 0.1)}));
  EXPECT_EQ(seen[5].time_ns, 1005 * kMillisecond_ns);
  EXPECT_NEAR(double(seen[30].time_ns), 1030e6 + 0.1 * 5e6, 1.0);
}

TEST(MockFaults, same_seed_gives_the_same_faults) {
  Options options = faulty({{FaultKind::drop, 0, 1, 0, 0.5}});
  const auto once = sequences(readings(options, 1000));
  EXPECT_EQ(sequences(readings(options, 1000)), once);
  EXPECT_NEAR(double(once.size()), 500, 60);
  options.fault_seed = 2;
  EXPECT_NE(sequences(readings(options, 1000)), once);
}

TEST(FaultyLine, values_repeat_swap_and_overtake_as_the_script_says) {
  const auto carried = [](FaultWindow w) {
    Faults faults({w}, 1);
    FaultyLine<int> line;
    std::vector<int> out;
    for (int i = 0; i < 6; ++i) {
      const auto now_ns = static_cast<std::uint64_t>(i) * kMillisecond_ns;
      line.push(i, 1e-3 * i, now_ns, faults);
      while (const auto value = line.pop(now_ns)) out.push_back(*value);
    }
    return out;
  };
  EXPECT_EQ(carried({FaultKind::repeat, 0.0015, 0.001, 0, 1}),
            (std::vector<int>{0, 1, 2, 2, 3, 4, 5}));
  EXPECT_EQ(carried({FaultKind::reorder, 0.0015, 0.001, 0, 1}),
            (std::vector<int>{0, 1, 3, 2, 4, 5}));
  EXPECT_EQ(carried({FaultKind::drop, 0.0015, 0.002, 0, 1}), (std::vector<int>{0, 1, 4, 5}));
  EXPECT_EQ(carried({FaultKind::delay, 0.0015, 0.001, 0.0015, 1}),
            (std::vector<int>{0, 1, 3, 2, 4, 5}));
}

}  // namespace
}  // namespace palpate::hal::mock
