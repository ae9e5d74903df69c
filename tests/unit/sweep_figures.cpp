// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace palpate::cli {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDelta_m = 0.001;
constexpr double kRadius_m = 0.02;

TickRow tick(Vec3d force_N, double distance_m, double bound_m = 0) {
  TickRow row;
  row.wrench.force_N = force_N;
  row.min_distance_m = distance_m;
  row.certificate.error_bound_m = bound_m;
  return row;
}

TEST(Percentile, Rank_is_the_least_value_that_the_share_does_not_exceed) {
  std::mt19937 random(1);
  for (std::size_t n = 1; n < 40; ++n) {
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i) values.push_back(double(random() % 20));
    for (const double share : {0.01, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      double oracle = std::numeric_limits<double>::infinity();
      for (const double v : values) {
        const auto below =
            std::count_if(values.begin(), values.end(), [&](double w) { return w <= v; });
        if (double(below) >= share * double(n)) oracle = std::min(oracle, v);
      }
      EXPECT_EQ(percentile(values, share), oracle) << n << " " << share;
    }
  }
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
}

TEST(Nrmse, Error_in_proportion_to_the_truth_is_that_proportion) {
  const std::vector<Vec3d> truth = {{1, 0, 0}, {0, 2, 0}, {0, 0, -3}};
  std::vector<Vec3d> values;
  for (const Vec3d v : truth) values.push_back(1.1 * v);
  EXPECT_NEAR(nrmse(values, truth), 0.1, 1e-15);
  EXPECT_EQ(nrmse(truth, truth), 0.0);
}

TEST(Nrmse, Nothing_true_gives_no_figure_unless_nothing_is_wrong) {
  const std::vector<Vec3d> zero(2), one = {{1, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(nrmse(zero, zero), 0.0);
  EXPECT_TRUE(std::isnan(nrmse(one, zero)));
  EXPECT_EQ(nrmse(zero, one), 1.0);
}

TEST(Noticeable, Error_must_exceed_both_share_and_floor) {
  const Observer observer{0.1, 0.02};
  EXPECT_FALSE(noticeable(observer, {1.09, 0, 0}, {1, 0, 0}));
  EXPECT_TRUE(noticeable(observer, {1.11, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(noticeable(observer, {0.069, 0, 0}, {0.05, 0, 0}));  // below the floor
  EXPECT_TRUE(noticeable(observer, {0.071, 0, 0}, {0.05, 0, 0}));
  EXPECT_TRUE(noticeable(observer, {0, 1, 0}, {1, 0, 0}));  // direction alone
  EXPECT_FALSE(noticeable(observer, {0.02, 0, 0}, {0, 0, 0}));
}

TEST(Certificate, Reported_distance_off_by_more_than_the_bound_breaks_it) {
  EXPECT_FALSE(certificate_broken(tick({}, 4e-4, 1e-4), 5e-4, kDelta_m, kRadius_m));
  EXPECT_TRUE(certificate_broken(tick({}, 3.9e-4, 1e-5), 5e-4, kDelta_m, kRadius_m));
  EXPECT_FALSE(certificate_broken(tick({}, 5e-4 + 3e-8), 5e-4, kDelta_m, kRadius_m));  // rounding
}

TEST(Certificate, Lost_contact_breaks_it_unless_the_bound_reaches_delta) {
  EXPECT_TRUE(certificate_broken(tick({}, kNone, 1e-4), 5e-4, kDelta_m, kRadius_m));
  EXPECT_FALSE(certificate_broken(tick({}, kNone, 6e-4), 5e-4, kDelta_m, kRadius_m));
  EXPECT_FALSE(certificate_broken(tick({}, kNone), 9.95e-4, kDelta_m, kRadius_m));
}

TEST(Certificate, Overlap_and_no_contact_are_not_judged) {
  EXPECT_FALSE(certificate_broken(tick({}, -5e-4), -1e-4, kDelta_m, kRadius_m));
  EXPECT_FALSE(certificate_broken(tick({}, 5e-4), kNone, kDelta_m, kRadius_m));
}

TEST(Figures, Ticks_against_themselves_lose_nothing) {
  const std::vector<TickRow> ticks = {tick({1, 0, 0}, 1e-4), tick({}, kNone),
                                      tick({0, 2, 0}, -1e-4)};
  const SweepFigures f = figures(ticks, ticks, {}, kDelta_m, kRadius_m);
  EXPECT_EQ(f.ticks, 3u);
  EXPECT_EQ(f.force_nrmse, 0.0);
  EXPECT_EQ(f.torque_nrmse, 0.0);
  EXPECT_EQ(f.noticeable, 0.0);
  EXPECT_EQ(f.true_error_median_m, 0.0);
  EXPECT_EQ(f.certificates_broken, 0u);
  EXPECT_TRUE(std::isnan(f.bound_over_error_median));
  EXPECT_NEAR(f.force_step_max_N, 2.0, 1e-15);
}

TEST(Figures, Times_count_only_where_a_tick_was_timed) {
  std::vector<TickRow> ticks(5, tick({1, 0, 0}, 1e-4));
  EXPECT_TRUE(std::isnan(figures(ticks, ticks, {}, kDelta_m, kRadius_m).median_ns));
  for (std::size_t i = 0; i < 3; ++i) ticks[i].time_ns = 100 * (i + 1);
  const SweepFigures f = figures(ticks, ticks, {}, kDelta_m, kRadius_m);
  EXPECT_EQ(f.timed_ticks, 3u);
  EXPECT_EQ(f.median_ns, 200.0);
  EXPECT_EQ(f.max_ns, 300.0);
}

TEST(Figures, Errors_of_force_direction_and_distance_are_those_of_the_ticks) {
  const std::vector<TickRow> exact = {tick({1, 0, 0}, 4e-4), tick({1, 0, 0}, 4e-4),
                                      tick({1, 0, 0}, 4e-4), tick({1, 0, 0}, 4e-4)};
  std::vector<TickRow> ticks = exact;
  ticks[1] = tick({0, 1, 0}, 3e-4, 2e-4);
  ticks[1].certificate.truncated_by_units = true;
  ticks[2].certificate.s_worst = 0.5;
  ticks[3].front_nodes = 8;
  ticks[3].queries = 4;
  const SweepFigures f = figures(ticks, exact, {}, kDelta_m, kRadius_m);
  EXPECT_NEAR(f.force_nrmse, std::sqrt(2.0 / 4), 1e-15);
  EXPECT_NEAR(f.force_error_max_N, std::sqrt(2.0), 1e-15);
  EXPECT_EQ(f.noticeable, 0.25);
  EXPECT_EQ(f.truncated, 0.25);
  EXPECT_EQ(f.direction_error_median_rad, 0.0);
  EXPECT_NEAR(f.bound_over_error_median, 2.0, 1e-12);
  EXPECT_EQ(f.error_bound_max_m, 2e-4);
  EXPECT_EQ(f.s_worst_max, 0.5);
  EXPECT_EQ(f.s_worst_mean, 0.125);
  EXPECT_EQ(f.front_mean, 2.0);
  EXPECT_EQ(f.queries_mean, 1.0);
}

TEST(TicksCsv, Table_reads_back_as_the_same_numbers) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<TickRow> ticks;
  for (std::size_t i = 0; i < 50; ++i) {
    TickRow row = tick({number(random), number(random), number(random)},
                       i % 3 == 0 ? kNone : 1e-4 * number(random), 1e-5);
    row.t_s = 1e-3 * double(i);
    row.wrench.torque_Nm = {number(random), 0, -0.0};
    row.contacts = i;
    row.time_ns = 1000 + i;
    row.certificate.truncated_by_memory = i % 2 == 0;
    ticks.push_back(row);
  }
  const auto back = ticks_from_csv(ticks_csv(ticks));
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), ticks.size());
  EXPECT_EQ(ticks_csv(*back), ticks_csv(ticks));
}

TEST(TicksCsv, Table_that_is_cut_or_changed_is_none) {
  const std::vector<TickRow> ticks(3, tick({1, 2, 3}, 1e-4));
  const std::string whole = ticks_csv(ticks);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto rows = ticks_from_csv(std::string_view(whole).substr(0, size));
    EXPECT_TRUE(!rows || rows->size() < ticks.size()) << size;
  }
  std::string other = whole;
  other[other.find("\n1,") + 1] = '5';
  EXPECT_FALSE(ticks_from_csv(other));
  other = whole;
  other.insert(other.size() - 1, ",7");
  EXPECT_FALSE(ticks_from_csv(other));
}

}  // namespace
}  // namespace palpate::cli
