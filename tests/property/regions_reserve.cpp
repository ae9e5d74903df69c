// SPDX-License-Identifier: GPL-3.0-or-later
// What a budget has in reserve: no tick in contact reports none, and none goes on for longer than
// it has to.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "host_bake/models/models.hpp"
#include "tests/support/counting_clock.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/gears.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kBeyond = 400;  // units of one vertex among triangles like needles

struct Count {
  int touching = 0, missed = 0, drawn = 0;
  int undecided = 0;  ///< by more than rounding
  std::uint64_t most_units = 0;
  void add(const TickResult& r, bool touches) {
    touching += touches ? 1 : 0;
    missed += touches && r.contacts.empty() ? 1 : 0;
    const bool rounded = r.certificate.error_bound_m < 1e-3 * Gears::kDelta;
    undecided += r.certificate.contact == ContactStatus::undecided && !rounded ? 1 : 0;
    drawn += r.certificate.on_reserve ? 1 : 0;
    most_units = std::max(most_units, r.certificate.units_used);
  }
};

/// Gears that come near and slide over each other.
Count slide_gears(const Gears& gears, double step, int coming_near, const Budget& budget) {
  constexpr int kSlides = effort(20, 2);
  std::mt19937 rng(5);
  Count count;
  for (int i = 0; i < kSlides; ++i) {
    BakedScene distances = gears.distances();
    BakedScene budgeted = gears.scene();
    Slide slide(distances, rng);
    slide.pose.position_m += coming_near * step * slide.down;
    for (int t = 0; t < coming_near + 60; ++t) {
      const Pose poses[2] = {slide.pose, {}};
      const bool touches = distance_at(distances, slide.pose) < 0.9999 * Gears::kDelta;
      count.add(tick_or_fail(*budgeted.engine, poses, budget), touches);
      if (t < coming_near) {
        slide.pose.position_m -= step * slide.down;
      } else {
        slide.go_on(step);
      }
    }
  }
  return count;
}

TEST(RegionsReserve, no_tick_in_contact_reports_none_however_small_its_budget) {
  const Gears gears(60, 50);
  for (const double of_delta : {0.1, 0.5}) {
    for (const std::uint64_t units : {1u, 50u}) {
      const double step = of_delta * Gears::kDelta;
      const Count none = slide_gears(gears, step, 20, {.units = units});
      const Count endless =
          slide_gears(gears, step, 20, {.units = units, .reserve_units = kEndless});
      EXPECT_GE(none.missed, effort(1, 0)) << units;
      EXPECT_EQ(endless.touching, none.touching);
      EXPECT_EQ(endless.missed, 0) << units;
      EXPECT_EQ(endless.undecided, 0) << units;
      EXPECT_LT(endless.most_units, 50'000u);
    }
  }
}

TEST(RegionsReserve, no_jump_into_contact_reports_none) {
  const Gears gears(24, 20);
  std::mt19937 rng(5);
  constexpr int kJumps = effort(40, 10);
  Count count;
  for (int i = 0; i < kJumps; ++i) {
    const Pose poses[2] = {met_at_random(gears.a.mesh, gears.b.mesh, 0.5 * Gears::kDelta, rng), {}};
    BakedScene scene = gears.scene();
    count.add(tick_or_fail(*scene.engine, poses, {.units = 1, .reserve_units = kEndless}), true);
  }
  EXPECT_EQ(count.missed, 0);
  EXPECT_EQ(count.drawn, kJumps);
}

/// Nothing is near that could cross, and what is inside is asked for as well.
TEST(RegionsReserve, body_deep_inside_another_is_felt_in_the_first_tick) {
  const BakedBody small(gear(12, 0.1, 0.05), options_for(bake::ForEngine::regions));
  const BakedBody large(gear(40, 1, 0.6), options_for(bake::ForEngine::regions));
  const Settings settings{.engine = EngineKind::regions, .delta_m = 0.01};
  for (const std::uint64_t units : {1u, 64u}) {
    BakedScene scene({small.view, large.view}, {{0, 1}}, settings);
    const Pose poses[2] = {{{0.4, 0.03, 0}, {}}, {}};
    EXPECT_TRUE(tick_or_fail(*scene.engine, poses, {.units = units}).contacts.empty());
    BakedScene other({small.view, large.view}, {{0, 1}}, settings);
    const Budget budget{.units = units, .reserve_units = kEndless};
    EXPECT_FALSE(tick_or_fail(*other.engine, poses, budget).contacts.empty()) << units;
  }
}

TEST(RegionsReserve, ticks_take_no_more_than_budget_and_reserve) {
  const Gears gears(60, 50);
  const Count count =
      slide_gears(gears, 0.5 * Gears::kDelta, 20, {.units = 50, .reserve_units = 300});
  EXPECT_GT(count.drawn, 0);
  EXPECT_GT(count.most_units, 100u);
  EXPECT_LE(count.most_units, 350u + kBeyond);
}

/// Not one bit is another where the budget answers the question.
TEST(RegionsReserve, ticks_that_feel_something_or_nothing_draw_on_none) {
  const Gears gears(60, 50);
  std::mt19937 rng(5);
  BakedScene distances = gears.distances();
  BakedScene without = gears.scene();
  BakedScene with = gears.scene();
  Slide slide(distances, rng);
  int felt = 0, drawn = 0;
  for (int t = 0; t < 60; ++t) {
    const Pose poses[2] = {slide.pose, {}};
    const TickResult x = tick_or_fail(*without.engine, poses, {.units = 1500});
    const TickResult y =
        tick_or_fail(*with.engine, poses, {.units = 1500, .reserve_units = kEndless});
    felt += x.contacts.empty() ? 0 : 1;
    drawn += y.certificate.on_reserve ? 1 : 0;
    EXPECT_EQ(std::memcmp(&x.wrench, &y.wrench, sizeof x.wrench), 0);
    EXPECT_EQ(x.certificate.units_used, y.certificate.units_used);
    slide.go_on(0.2 * Gears::kDelta);
    if (t == 30) slide.pose.position_m += 3.0 * slide.down;  // far
  }
  EXPECT_GT(felt, 20);
  EXPECT_EQ(drawn, 0);
}

/// A contact of one pair tells nothing of another.
TEST(RegionsReserve, every_pair_that_touches_is_felt) {
  const Gears gears(24, 20);
  std::mt19937 rng(5);
  constexpr int kJumps = effort(10, 3);
  constexpr Vec3d kAside{4, 0, 0};
  int lost = 0;
  for (int i = 0; i < kJumps; ++i) {
    const Pose one = met_at_random(gears.a.mesh, gears.b.mesh, 0.5 * Gears::kDelta, rng);
    Pose other = met_at_random(gears.a.mesh, gears.b.mesh, 0.5 * Gears::kDelta, rng);
    other.position_m += kAside;
    // Two pairs that touch, far from each other.
    const Pose poses[4] = {one, {}, other, {kAside, {}}};
    BakedScene scene({gears.a.view, gears.b.view, gears.a.view, gears.b.view}, {{0, 1}, {2, 3}},
                     {.engine = EngineKind::regions, .delta_m = Gears::kDelta});
    const TickResult r =
        tick_or_fail(*scene.engine, poses, {.units = 1, .reserve_units = kEndless});
    bool felt[2] = {};
    for (const Contact& c : r.contacts) felt[c.pair] = true;
    lost += felt[0] && felt[1] ? 0 : 1;
  }
  EXPECT_EQ(lost, 0);
}

TEST(RegionsReserve, time_in_reserve_is_after_the_deadline) {
  const Gears gears(24, 20);
  std::mt19937 rng(5);
  const Pose poses[2] = {met_at_random(gears.a.mesh, gears.b.mesh, 0.5 * Gears::kDelta, rng), {}};
  const auto tick_with = [&](std::uint64_t reserve_ns) {
    BakedScene scene = gears.scene();
    CountingClock clock{.now = 100};
    const TickResult r = tick_or_fail(*scene.engine, poses,
                                      {.clock_ns = CountingClock::read,
                                       .clock_context = &clock,
                                       .deadline_ns = 0,
                                       .reserve_ns = reserve_ns});
    EXPECT_EQ(r.certificate.on_reserve, reserve_ns > 0);
    return r;
  };
  EXPECT_TRUE(tick_with(0).certificate.truncated_by_time);
  EXPECT_FALSE(tick_with(1'000'000).contacts.empty());
  EXPECT_FALSE(tick_with(kEndless).contacts.empty());
}

/// Its truncated front is felt as it is.
TEST(RegionsReserve, levels_have_no_use_for_it) {
  const BakedBody a(bake::make_model("jaw_lower", 1000), bake::ForEngine::levels);
  const BakedBody b(bake::make_model("jaw_upper", 1000), bake::ForEngine::levels);
  const Settings settings{.delta_m = 5e-4};
  BakedScene without({a.view, b.view}, {{0, 1}}, settings);
  BakedScene with({a.view, b.view}, {{0, 1}}, settings);
  for (int i = 0; i < 20; ++i) {
    const Pose poses[2] = {{{0, 0, 1e-4 * i}, {}}, {}};
    const TickResult x = tick_or_fail(*without.engine, poses, {.units = 5});
    const TickResult y = tick_or_fail(*with.engine, poses, {.units = 5, .reserve_units = kEndless});
    EXPECT_EQ(std::memcmp(&x.wrench, &y.wrench, sizeof x.wrench), 0);
    EXPECT_EQ(x.queries, y.queries);
    EXPECT_FALSE(y.certificate.on_reserve);
  }
}

}  // namespace
}  // namespace palpate::test
