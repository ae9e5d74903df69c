// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever ends refinement, the answer is valid: the certificate holds, nothing is lost, results
// repeat.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "tests/support/answers.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/counting_clock.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

Pose slide(int i) {
  return {{1.75 + 0.02 * std::sin(0.2 * i), 0.3 * std::sin(0.03 * i), 0.004 * i},
          turn({0.01 * i, 0.004 * i, 0})};
}

struct Bodies {
  BakedBody a{bumpy_ball(14, 20, 1)};
  BakedBody b{bumpy_ball(16, 16, 0.8)};
};

const Bodies& bodies() {
  static const Bodies both;
  return both;
}

constexpr double kDelta = 0.05;
const Settings kSettings{.delta_m = kDelta, .exact = true, .cluster_radius_m = 0.1};

TEST(EngineBudget, every_budget_gives_a_true_certificate) {
  const std::vector<double> truth = distances_along(bodies().a.mesh, bodies().b.mesh, slide, 40);
  double last_mean = std::numeric_limits<double>::infinity();
  for (const std::uint64_t units : {0u, 1u, 2u, 5u, 20u, 50u, 200u, 1000u, 100000u}) {
    BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings);
    double mean = 0;
    for (int i = 0; i < 40; ++i) {
      const Pose poses[2] = {slide(i), {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_LE(r.queries, units);
      EXPECT_EQ(r.certificate.units_used, r.queries);
      expect_certified(r, truth[static_cast<std::size_t>(i)], kDelta);
      mean += r.certificate.error_bound_m / 40;
    }
    EXPECT_LE(mean, 1.05 * last_mean) << units << " units";
    last_mean = mean;
  }
  EXPECT_LT(last_mean, 1e-5);
}

TEST(EngineBudget, few_nodes_are_a_reported_graceful_stop) {
  const PlacedTriangles fixed(bodies().b.mesh, {});
  for (const std::uint32_t nodes : {1u, 2u, 10u, 100u}) {
    BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings, {.nodes = nodes});
    for (int i = 0; i < 10; ++i) {
      const Pose poses[2] = {slide(i), {}};
      const TickResult r = tick_or_fail(*scene.engine, poses);
      EXPECT_TRUE(r.certificate.truncated_by_memory);
      expect_certified(r, distance_of(PlacedTriangles(bodies().a.mesh, poses[0]), fixed), kDelta);
    }
  }
}

TEST(EngineBudget, few_nodes_without_a_budget_go_to_what_is_nearest) {
  for (const std::uint32_t nodes : {2u, 10u, 100u}) {
    BakedScene one({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings, {.nodes = nodes});
    BakedScene other({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings, {.nodes = nodes});
    const Pose poses[2] = {slide(0), {}};
    const TickResult r = tick_or_fail(*one.engine, poses);
    const TickResult s = tick_or_fail(*other.engine, poses, {.units = 1000000});
    EXPECT_TRUE(r.certificate.truncated_by_memory);
    EXPECT_EQ(r.contacts.size(), s.contacts.size());
    EXPECT_EQ(r.certificate.error_bound_m, s.certificate.error_bound_m);
    EXPECT_NEAR(norm(r.wrench.force_N - s.wrench.force_N), 0, 1e-12);
  }
}

TEST(EngineBudget, few_nodes_are_not_found_too_few_in_every_tick) {
  const Limits few{.nodes = 100};
  BakedScene endless({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings, few);
  BakedScene by_worth({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings, few);
  double queries = 0;
  double queries_by_worth = 0;
  for (int i = 0; i < 30; ++i) {
    const Pose poses[2] = {slide(i), {}};
    const TickResult r = tick_or_fail(*endless.engine, poses);
    const TickResult s = tick_or_fail(*by_worth.engine, poses, {.units = 1000000});
    ASSERT_TRUE(r.certificate.truncated_by_memory);
    if (i == 0) continue;
    queries += static_cast<double>(r.queries);
    queries_by_worth += static_cast<double>(s.queries);
  }
  EXPECT_NEAR(queries, queries_by_worth, 0.1 * queries_by_worth);
}

TEST(EngineBudget, room_is_tried_again_after_a_tick_that_fits) {
  const Pose near[2] = {slide(0), {}};
  const Pose apart[2] = {{{4, 0, 0}, {}}, {}};
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings, {.nodes = 100});
  const std::uint64_t both_ways = tick_or_fail(*scene.engine, near).queries;
  EXPECT_LT(tick_or_fail(*scene.engine, near).queries, both_ways / 2);
  ASSERT_FALSE(tick_or_fail(*scene.engine, apart).certificate.truncated_by_memory);
  EXPECT_EQ(tick_or_fail(*scene.engine, near).queries, both_ways);
}

TEST(EngineBudget, few_contacts_are_a_reported_graceful_stop) {
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings, {.contacts = 1});
  const PlacedTriangles fixed(bodies().b.mesh, {});
  bool met = false;
  for (int i = 0; i < 10; ++i) {
    const Pose poses[2] = {slide(i), {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    met |= r.certificate.truncated_by_memory;
    EXPECT_LE(r.contacts.size(), 1u);
    expect_certified(r, distance_of(PlacedTriangles(bodies().a.mesh, poses[0]), fixed), kDelta);
  }
  EXPECT_TRUE(met);
}

TEST(EngineBudget, deadline_ends_refinement) {
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings);
  const PlacedTriangles fixed(bodies().b.mesh, {});
  const Pose poses[2] = {slide(0), {}};
  CountingClock clock;
  const TickResult r =
      tick_or_fail(*scene.engine, poses,
                   {.clock_ns = CountingClock::read, .clock_context = &clock, .deadline_ns = 20});
  EXPECT_TRUE(r.certificate.truncated_by_time);
  EXPECT_LE(r.queries, 20u);
  expect_certified(r, distance_of(PlacedTriangles(bodies().a.mesh, poses[0]), fixed), kDelta);
}

TEST(EngineBudget, same_input_gives_the_same_bits) {
  for (const std::uint64_t units : {30u, 300u, 100000u}) {
    BakedScene one({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings);
    BakedScene other({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings);
    for (int i = 0; i < 60; ++i) {
      const Pose poses[2] = {slide(i), {}};
      const TickResult r = tick_or_fail(*one.engine, poses, {.units = units});
      const TickResult s = tick_or_fail(*other.engine, poses, {.units = units});
      ASSERT_EQ(std::memcmp(&r.wrench, &s.wrench, sizeof r.wrench), 0);
      ASSERT_EQ(r.contacts.size(), s.contacts.size());
    }
  }
}

// Apart, so that witnesses are unique; where parallel faces overlap, any point of them is deepest.
TEST(EngineBudget, exact_answer_does_not_depend_on_history) {
  BakedScene warm({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings);
  for (int i = 0; i < 60; ++i) {
    Pose poses[2] = {slide(i), {}};
    poses[0].position_m.x += 0.06;
    const TickResult r = tick_or_fail(*warm.engine, poses);
    BakedScene cold({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings);
    const TickResult s = tick_or_fail(*cold.engine, poses);
    ASSERT_EQ(r.contacts.size(), s.contacts.size());
    if (!r.contacts.empty()) {
      EXPECT_NEAR(r.min_distance_m, s.min_distance_m, 1e-8);
    }
    EXPECT_NEAR(norm(r.wrench.force_N - s.wrench.force_N), 0, 1e-5 * (1 + norm(s.wrench.force_N)));
  }
}

TEST(EngineBudget, front_comes_back_up_when_the_bodies_part) {
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, kSettings);
  Pose poses[2] = {slide(0), {}};
  const TickResult near = tick_or_fail(*scene.engine, poses);
  EXPECT_GT(near.front_nodes, 10u);
  for (int i = 0; i < 200; ++i) {
    poses[0].position_m.x += 0.02;
    const TickResult far = tick_or_fail(*scene.engine, poses);
    if (i == 199) {
      EXPECT_EQ(far.front_nodes, 1u);
      EXPECT_EQ(far.queries, 0u);
    }
  }
}

}  // namespace
}  // namespace palpate::test
