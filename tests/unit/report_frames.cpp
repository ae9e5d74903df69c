// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace palpate::cli {
namespace {

TEST(ReportFrames, frames_cover_every_tick_and_stay_below_the_limit) {
  for (std::size_t ticks = 1; ticks <= 60; ++ticks) {
    for (std::size_t limit = 1; limit <= 20; ++limit) {
      const Frames frames = frames_of(ticks, limit);
      EXPECT_LE(frames.count, limit);
      EXPECT_LT(frames.tick(frames.count - 1), ticks);
      EXPECT_GE(frames.tick(frames.count), ticks);
      if (ticks <= limit) {
        EXPECT_EQ(frames.count, ticks);
      }
    }
  }
}

TEST(ReportFrames, sample_is_the_frame_s_own_tick_and_peak_the_largest_until_the_next) {
  const std::vector<double> values = {1, 9, 2, 3, 4, 8, 5};
  const Frames frames = frames_of(values.size(), 3);
  ASSERT_EQ(frames.stride, 3u);
  const auto value = [&](std::size_t tick) { return values[tick]; };
  EXPECT_EQ(frames.sample(value), (std::vector<float>{1, 3, 5}));
  EXPECT_EQ(frames.peak(value), (std::vector<float>{9, 8, 5}));
}

TEST(ReportFrames, bins_hold_each_timed_duration_once_and_where_it_belongs) {
  std::mt19937_64 random(8);
  std::vector<std::vector<std::uint64_t>> sets(3);
  for (auto& set : sets) {
    for (int i = 0; i < 500; ++i) set.push_back(random() % (std::uint64_t(1) << (1 + i % 40)));
  }
  const DurationBins bins = bin_durations(sets);
  const double width = std::exp2(1.0 / kBinsPerOctave);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (std::size_t b = 0; b < bins.from_us.size(); ++b) {
      const double from_ns = 1e3 * double(bins.from_us[b]);
      const auto expected = std::count_if(sets[s].begin(), sets[s].end(), [&](std::uint64_t ns) {
        return double(ns) >= from_ns * (1 - 1e-6) && double(ns) < from_ns * width * (1 - 1e-6);
      });
      EXPECT_EQ(bins.counts[s][b], expected) << from_ns;
    }
    const auto timed =
        std::count_if(sets[s].begin(), sets[s].end(), [](auto ns) { return ns > 0; });
    EXPECT_EQ(std::accumulate(bins.counts[s].begin(), bins.counts[s].end(), 0u), timed);
  }
}

TEST(ReportFrames, bins_of_nothing_timed_are_none) {
  const std::vector<std::vector<std::uint64_t>> sets = {{}, {0, 0}};
  EXPECT_TRUE(bin_durations(sets).from_us.empty());
}

TEST(ReportFrames, quantile_is_of_the_nearest_rank_and_passes_over_gaps) {
  const double gap = std::nan("");
  EXPECT_EQ(quantile({4, gap, 1, 3, 2}, 0.5), 2);
  EXPECT_EQ(quantile({4, gap, 1, 3, 2}, 0.51), 3);
  EXPECT_EQ(quantile({4, gap, 1, 3, 2}, 1.0), 4);
  EXPECT_EQ(quantile({7}, 0.001), 7);
  EXPECT_TRUE(std::isnan(quantile({gap}, 0.5)));
}

TEST(ReportFrames, distance_error_needs_both_distances) {
  TickRow a, b;
  a.min_distance_m = 3e-4;
  b.min_distance_m = -1e-4;
  EXPECT_DOUBLE_EQ(distance_error_m(a, b), 4e-4);
  b.min_distance_m = std::nan("");
  EXPECT_TRUE(std::isnan(distance_error_m(a, b)));
}

}  // namespace
}  // namespace palpate::cli
