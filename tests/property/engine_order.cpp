// SPDX-License-Identifier: GPL-3.0-or-later
// What is refined first under a budget: more budget is felt no worse, and what is certified is
// true.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/answers.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr double kDelta = 0.05;
constexpr int kTicks = 40;
constexpr int kSettled = 10;

struct Bodies {
  BakedBody a{bumpy_ball(28, 40, 1)};
  BakedBody b{bumpy_ball(32, 32, 0.8)};
};

const Bodies& bodies() {
  static const Bodies both;
  return both;
}

// Surfaces that do not cross: where they do, a whole area is as deep as its deepest point, and
// which point stands for it depends on what was measured before.
Pose slide(int i) {
  return {{1.79 + 0.02 * std::sin(0.2 * i), 0.3 * std::sin(0.03 * i), 0.004 * i},
          turn({0.01 * i, 0.004 * i, 0})};
}

Settings settings(Order order) {
  return {.delta_m = kDelta, .exact = true, .order = order, .cluster_radius_m = 0.1};
}

std::vector<TickResult> answers(const Settings& settings, const Budget& budget) {
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  std::vector<TickResult> out;
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[2] = {slide(i), {}};
    out.push_back(tick_or_fail(*scene.engine, poses, budget));
  }
  return out;
}

/// Root mean square of the differences, over the largest true force.
double force_error(const std::vector<TickResult>& found, const std::vector<TickResult>& truth) {
  double most = 0;
  double sum = 0;
  for (std::size_t i = kSettled; i < found.size(); ++i) {
    most = std::max(most, norm(truth[i].wrench.force_N));
    sum += squared_norm(found[i].wrench.force_N - truth[i].wrench.force_N);
  }
  return std::sqrt(sum / (kTicks - kSettled)) / most;
}

TEST(EngineOrder, more_budget_is_felt_no_worse) {
  const std::vector<TickResult> truth = answers(settings(Order::force), {});
  constexpr double kNoWorse = 0.02;
  double last = std::numeric_limits<double>::infinity();
  for (std::uint64_t units = 16; units <= 16384; units *= 2) {
    const double error = force_error(answers(settings(Order::force), {.units = units}), truth);
    EXPECT_LE(error, last + kNoWorse) << units << " units";
    last = error;
  }
  EXPECT_LT(last, 1e-6);
}

TEST(EngineOrder, force_first_is_nearer_to_the_force_than_deviation_first) {
  const std::vector<TickResult> truth = answers(settings(Order::force), {});
  for (const std::uint64_t units : {64u, 128u, 256u}) {
    const double by_force = force_error(answers(settings(Order::force), {.units = units}), truth);
    const double by_deviation =
        force_error(answers(settings(Order::deviation), {.units = units}), truth);
    EXPECT_LT(by_force, by_deviation) << units << " units";
  }
}

TEST(EngineOrder, no_contact_is_lost_once_the_budget_leads_down_to_one) {
  for (const std::uint64_t units : {512u, 1024u, 2048u}) {
    const std::vector<TickResult> found = answers(settings(Order::force), {.units = units});
    const std::vector<TickResult> truth = answers(settings(Order::force), {});
    for (std::size_t i = 1; i < found.size(); ++i) {
      if (!truth[i].contacts.empty() && truth[i].min_distance_m < 0.5 * kDelta) {
        EXPECT_FALSE(std::isnan(found[i].min_distance_m)) << units << " units, tick " << i;
      }
    }
  }
}

TEST(EngineOrder, without_a_budget_the_order_changes_nothing) {
  for (const bool exact : {false, true}) {
    Settings by_force = settings(Order::force);
    by_force.exact = exact;
    Settings by_deviation = by_force;
    by_deviation.order = Order::deviation;
    const std::vector<TickResult> one = answers(by_force, {});
    const std::vector<TickResult> other = answers(by_deviation, {});
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].queries, other[i].queries);
      EXPECT_EQ(one[i].wrench.force_N.x, other[i].wrench.force_N.x);
      EXPECT_EQ(one[i].certificate.error_bound_m, other[i].certificate.error_bound_m);
    }
  }
}

TEST(EngineOrder, certificate_is_true_with_any_order) {
  const std::vector<double> truth =
      distances_along(bodies().a.mesh, bodies().b.mesh, slide, kTicks);
  for (const Order order : {Order::deviation, Order::force}) {
    for (const double s0 : {0.0, 0.02}) {
      for (const std::uint64_t units : {8u, 64u, 512u, 4096u}) {
        Settings with = settings(order);
        with.exact = false;
        with.s0 = s0;
        const std::vector<TickResult> found = answers(with, {.units = units});
        for (std::size_t i = 0; i < found.size(); ++i) expect_certified(found[i], truth[i], kDelta);
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
