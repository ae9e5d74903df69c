// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace palpate::realtime {
namespace {

TEST(Histogram, empty_has_zero_percentiles) {
  const Histogram h;
  EXPECT_EQ(h.percentile_ns(0.5), 0u);
  EXPECT_EQ(h.max_ns(), 0u);
}

TEST(Histogram, small_values_are_exact) {
  Histogram h;
  for (std::uint64_t v = 0; v < 64; ++v) h.add(v);
  EXPECT_EQ(h.percentile_ns(0.5), 31u);
  EXPECT_EQ(h.percentile_ns(1.0), 63u);
  EXPECT_EQ(h.percentile_ns(0.0), 0u);
}

TEST(Histogram, percentiles_match_sorted_values_within_the_bucket) {
  std::mt19937_64 random(3);
  std::lognormal_distribution<double> spread(9, 2.5);
  Histogram h;
  std::vector<std::uint64_t> values;
  for (int i = 0; i < 100'000; ++i) {
    values.push_back(static_cast<std::uint64_t>(spread(random)));
    h.add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double share : {0.001, 0.25, 0.5, 0.9, 0.99, 0.999, 0.9999, 1.0}) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    const std::uint64_t exact = values[static_cast<std::size_t>(rank) - 1];
    const std::uint64_t got = h.percentile_ns(share);
    EXPECT_GE(got, exact) << share;
    EXPECT_LE(got, exact + exact / Histogram::kSubBuckets) << share;
  }
  EXPECT_EQ(h.percentile_ns(1.0), values.back());
}

TEST(Histogram, every_power_of_two_and_its_neighbours_keep_their_order) {
  for (int bit = 0; bit < 64; ++bit) {
    const std::uint64_t v = std::uint64_t(1) << bit;
    Histogram h;
    h.add(v - 1);
    h.add(v);
    EXPECT_EQ(h.max_ns(), v);
    EXPECT_GE(h.percentile_ns(0.5), v - 1);
    EXPECT_EQ(h.percentile_ns(1.0), v);
  }
}

TEST(Histogram, largest_value_has_a_bucket) {
  Histogram h;
  h.add(std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(h.percentile_ns(0.5), std::numeric_limits<std::uint64_t>::max());
}

TEST(Histogram, counts_between_bucket_limits_add_up) {
  Histogram h;
  for (std::uint64_t v = 0; v < 4096; ++v) h.add(v);
  EXPECT_EQ(h.count_between(0, 1024), 1024u);
  EXPECT_EQ(h.count_between(1024, 2048), 1024u);
  EXPECT_EQ(h.count_between(2048, 1u << 20), 2048u);
  EXPECT_EQ(h.total(), 4096u);
}

}  // namespace
}  // namespace palpate::realtime
