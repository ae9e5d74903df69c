// SPDX-License-Identifier: GPL-3.0-or-later
// The region engine inside budgets: the certificate holds, nothing is lost, results repeat, memory
// stays alone.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include "host_bake/models/models.hpp"
#include "rt_core/counters.hpp"
#include "rt_core/regions/search.hpp"
#include "tests/support/allocation_trap.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/counting_clock.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/gears.hpp"
#include "tests/support/ground.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

/// Slides, and jumps every so often.
Pose motion(int i) {
  const double jump = i % 25 == 24 ? 0.4 : 0;
  return {{1.75 + 0.02 * std::sin(0.2 * i), 0.3 * std::sin(0.03 * i) + jump, 0.004 * i},
          turn({0.01 * i, 0.004 * i, 0})};
}

struct Bodies {
  BakedBody a{bumpy_ball(20, 28, 1), bake::ForEngine::regions};
  BakedBody b{bumpy_ball(16, 16, 0.8), bake::ForEngine::regions};
};

const Bodies& bodies() {
  static const Bodies both;
  return both;
}

constexpr double kDelta = 0.05;
constexpr int kTicks = 60;
const Settings kSettings{
    .engine = EngineKind::regions, .delta_m = kDelta, .exact = true, .cluster_radius_m = 0.1};

BakedScene scene_with(const Settings& settings, const Limits& limits = {}) {
  return {{bodies().a.view, bodies().b.view}, {{0, 1}}, settings, limits};
}

const std::vector<double>& truth() {
  static const std::vector<double> all =
      distances_along(bodies().a.mesh, bodies().b.mesh, motion, kTicks);
  return all;
}

void expect_certified(const TickResult& r, double distance) {
  const double bound = r.certificate.error_bound_m;
  ASSERT_TRUE(std::isfinite(bound));
  if (r.contacts.empty()) {
    EXPECT_GE(distance + bound, 0.9999 * kDelta) << "a contact was lost";
    const bool touches = distance < 0.9999 * kDelta;
    EXPECT_FALSE(touches && r.certificate.contact == ContactStatus::ruled_out);
  } else if (distance > 0) {
    EXPECT_LE(std::abs(r.min_distance_m - distance), bound + 2e-6);
  }
}

double sum_of_forces(const TickResult& r) {
  double sum = 0;
  for (const Contact& c : r.contacts) sum += kSettings.stiffness_N_per_m * (kDelta - c.distance_m);
  return sum;
}

std::ptrdiff_t contacts_of(const TickResult& r, std::uint32_t pair) {
  return std::count_if(r.contacts.begin(), r.contacts.end(),
                       [&](const Contact& c) { return c.pair == pair; });
}

/// What crosses is known by a distance of zero, and then by how deep it is, which takes a search of
/// its own: a budget that does for nearly all of a tick has to do for both.
TEST(RegionsBudget, depths_of_what_crosses_are_known_where_the_budget_nearly_does_for_all) {
  const BakedBody upper(bake::make_model("jaw_upper", 3000), bake::ForEngine::regions);
  const BakedBody lower(bake::make_model("jaw_lower", 3000), bake::ForEngine::regions);
  const Settings settings{.engine = EngineKind::regions, .delta_m = 5e-4, .cluster_radius_m = 1e-3};
  BakedScene exact({upper.view, lower.view}, {{0, 1}}, settings);
  BakedScene budgeted({upper.view, lower.view}, {{0, 1}}, settings);
  double squares = 0, peak = 0, units = 0;
  int crossing = 0, ticks = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose poses[2] = {ground(0.1, i), {}};
    const TickResult truth = tick_or_fail(*exact.engine, poses);
    const TickResult found = tick_or_fail(*budgeted.engine, poses, {.units = 1500});
    if (i < 50) continue;
    ++ticks;
    units += static_cast<double>(truth.queries);
    for (const Contact& c : truth.contacts) crossing += c.distance_m < 0 ? 1 : 0;
    squares += squared_norm(found.wrench.force_N - truth.wrench.force_N);
    peak = std::max(peak, norm(truth.wrench.force_N));
  }
  RecordProperty("units", std::to_string(units / ticks));
  RecordProperty("error", std::to_string(std::sqrt(squares / ticks) / peak));
  EXPECT_GT(crossing, 2 * ticks);
  EXPECT_GT(units / ticks, 1500);
  EXPECT_LT(std::sqrt(squares / ticks) / peak, 0.03);
}

/// A model baked for the region engine, once however many tests ask for it.
const BakedBody& baked(const std::string& model, std::size_t triangles, double delta_rel) {
  static std::map<std::tuple<std::string, std::size_t, double>, BakedBody> kept;
  bake::BakeOptions options = options_for(bake::ForEngine::regions);
  options.delta_rel = delta_rel;
  const auto key = std::tuple(model, triangles, delta_rel);
  const auto at = kept.find(key);
  if (at != kept.end()) return at->second;
  return kept.try_emplace(key, bake::make_model(model, triangles), options).first->second;
}

/// Two models and the settings of their scene, delta relative to the first one's radius.
struct Models {
  Models(const char* of_a, const char* of_b, std::size_t triangles, double delta_rel)
      : a(baked(of_a, triangles, delta_rel)), b(baked(of_b, triangles, delta_rel)) {
    settings.delta_m = settings.cluster_radius_m = delta_rel * a.view.header->radius_m;
  }
  BakedScene scene() const { return {{a.view, b.view}, {{0, 1}}, settings}; }

  const BakedBody &a, &b;
  Settings settings{.engine = EngineKind::regions};
};

struct AfterJumps {
  double units = 0;  ///< of an exact tick, in the mean
  double error = 0;  ///< of the force, over its peak
};

/// Jaws at places in and about a bite, each by an engine that knows nothing.
AfterJumps after_jumps(const Models& jaws, std::uint64_t budget_units, int jumps) {
  AfterJumps out;
  double squares = 0, peak = 0;
  for (int i = 0; i < jumps; ++i) {
    Pose poses[2] = {ground(0.1, 15 * i), {}};
    poses[0].position_m.z += 8e-4;  // apart
    BakedScene exact = jaws.scene();
    BakedScene budgeted = jaws.scene();
    const TickResult truth = tick_or_fail(*exact.engine, poses);
    const TickResult found = tick_or_fail(*budgeted.engine, poses, {.units = budget_units});
    out.units += static_cast<double>(truth.queries) / jumps;
    squares += squared_norm(found.wrench.force_N - truth.wrench.force_N) / jumps;
    peak = std::max(peak, norm(truth.wrench.force_N));
  }
  out.error = std::sqrt(squares) / peak;
  testing::Test::RecordProperty("units", std::to_string(out.units));
  testing::Test::RecordProperty("error", std::to_string(out.error));
  return out;
}

/// Nearly everything is open then, and the force is that of the deepest contacts: some cross, whose
/// directions take units of their own, however the others are found.
TEST(RegionsBudget, after_a_jump_what_is_deepest_is_known_first) {
  constexpr std::uint64_t kUnits = 4000;
  const AfterJumps found =
      after_jumps(Models("jaw_upper", "jaw_lower", 24'000, 0.02), kUnits, effort(40, 10));
  EXPECT_GT(found.units, static_cast<double>(kUnits));
  EXPECT_LT(found.error, 0.03);
}

/// Most regions that may be near are ruled out by a few units, some take hundreds: three searches
/// told that the tick does for all, and forces were off by a fifth.
TEST(RegionsBudget, after_a_jump_a_few_searches_do_not_tell_for_all) {
  constexpr std::uint64_t kUnits = 1000;
  const AfterJumps found =
      after_jumps(Models("jaw_upper", "jaw_lower", 6000, 0.01), kUnits, effort(40, 10));
  EXPECT_GT(found.units, static_cast<double>(kUnits));
  EXPECT_LT(found.error, 0.05);
}

/// Of some two thousand regions twenty are near: a budget that does for searching those and for
/// ruling out the others has all contacts.
TEST(RegionsBudget, few_near_regions_of_many_are_found_after_a_jump) {
  const Models balls("golf_ball", "golf_ball", 20'000, 0.01);
  const double radius_m = balls.a.view.header->radius_m;
  constexpr std::uint64_t kUnits = 3000;
  constexpr int kPoses = effort(20, 6);
  double most = 0;
  int felt = 0;
  for (int i = 0; i < kPoses; ++i) {
    const Pose poses[2] = {{{2 * radius_m, 0, 0}, turn({0.4 * i, 0.7 * i, 0.1 * i})}, {}};
    BakedScene exact = balls.scene();
    BakedScene budgeted = balls.scene();
    const TickResult truth = tick_or_fail(*exact.engine, poses);
    const TickResult found = tick_or_fail(*budgeted.engine, poses, {.units = kUnits});
    most = std::max(most, static_cast<double>(truth.queries));
    felt += truth.contacts.empty() ? 0 : 1;
    EXPECT_EQ(found.contacts.size(), truth.contacts.size());
    EXPECT_LE(norm(found.wrench.force_N - truth.wrench.force_N), 1e-3 * norm(truth.wrench.force_N));
  }
  RecordProperty("regions", static_cast<int>(balls.a.view.regions.size()));
  RecordProperty("units", std::to_string(most));
  EXPECT_GT(felt, kPoses / 2);
  EXPECT_LT(most, kUnits);
}

/// @param angle  that it has gone round
Pose touching_ball(double radius_m, double angle) {
  const double apart_m = 1.985 * radius_m;
  return {{apart_m * std::cos(angle), apart_m * std::sin(angle), 0}, {}};
}

/// A ball slides over another by half of delta a tick, with units for a few climbs and searches:
/// where it touches is followed over the surface, from region to region.
TEST(RegionsBudget, fast_bodies_do_not_lose_touch) {
  constexpr double kDeltaRel = 0.02;
  constexpr int kSlide = effort(300, 60);
  const Models balls("golf_ball", "golf_ball", 20'000, kDeltaRel);
  const double radius_m = balls.a.view.header->radius_m;
  BakedScene exact = balls.scene();
  BakedScene budgeted = balls.scene();
  int touching = 0, lost = 0;
  double squares = 0, peak = 0;
  for (int i = 0; i < kSlide; ++i) {
    const Pose poses[2] = {touching_ball(radius_m, 0.25 * kDeltaRel * i), {}};
    const TickResult truth = tick_or_fail(*exact.engine, poses);
    const TickResult found = tick_or_fail(*budgeted.engine, poses, {.units = 70});
    if (i < 20 || truth.contacts.empty()) continue;
    ++touching;
    lost += found.contacts.empty() ? 1 : 0;
    squares += squared_norm(found.wrench.force_N - truth.wrench.force_N);
    peak = std::max(peak, norm(truth.wrench.force_N));
  }
  const double error = std::sqrt(squares / touching) / peak;
  RecordProperty("error", std::to_string(error));
  EXPECT_GT(touching, kSlide - 50);
  EXPECT_EQ(lost, 0);
  EXPECT_LT(error, 0.35);
}

/// What is done however late a tick is goes to where the ball touches.
TEST(RegionsBudget, fast_bodies_do_not_lose_touch_in_ticks_that_are_late_when_they_begin) {
  constexpr double kDeltaRel = 0.01;
  constexpr int kSlide = effort(300, 60);
  const Models balls("golf_ball", "golf_ball", 20'000, kDeltaRel);
  const double radius_m = balls.a.view.header->radius_m;
  BakedScene exact = balls.scene();
  BakedScene late = balls.scene();
  CountingClock clock;
  int touching = 0, lost = 0;
  for (int i = 0; i < kSlide; ++i) {
    const Pose poses[2] = {touching_ball(radius_m, 0.25 * kDeltaRel * i), {}};
    const TickResult truth = tick_or_fail(*exact.engine, poses);
    Budget budget;
    if (i > 0) {
      budget = {.clock_ns = CountingClock::read, .clock_context = &clock, .deadline_ns = 0};
    }
    const TickResult found = tick_or_fail(*late.engine, poses, budget);
    if (truth.contacts.empty()) continue;
    ++touching;
    lost += found.contacts.empty() ? 1 : 0;
  }
  RecordProperty("lost", lost);
  EXPECT_GT(touching, kSlide - 50);
  EXPECT_EQ(lost, 0);
}

/// Where the ball touches is not known, and what a tick has does not do for ruling out the rest.
TEST(RegionsBudget, however_little_there_is_after_a_jump_some_contact_is_known) {
  const Models balls("golf_ball", "golf_ball", 20'000, 0.01);
  const double radius_m = balls.a.view.header->radius_m;
  constexpr int kJumps = effort(100, 10);
  int touching = 0, lost = 0;
  for (int i = 0; i < kJumps; ++i) {
    const Pose poses[2] = {{{1.99 * radius_m, 0, 0}, turn({0.4 * i, 0.7 * i, 0.1 * i})}, {}};
    BakedScene exact = balls.scene();
    BakedScene budgeted = balls.scene();
    if (tick_or_fail(*exact.engine, poses).contacts.empty()) continue;
    ++touching;
    lost += tick_or_fail(*budgeted.engine, poses, {.units = 100}).contacts.empty() ? 1 : 0;
  }
  RecordProperty("lost", lost);
  EXPECT_GT(touching, 9 * kJumps / 10);
  EXPECT_EQ(lost, 0);
}

/// Flanks may be near anywhere along them. Looked from at their centres alone half of these jumps
/// felt nothing, and without searches of what looks have missed, eight.
TEST(RegionsBudget, after_a_jump_needles_are_found_to_touch) {
  const Gears gears(24, 20);
  std::mt19937 rng(5);
  constexpr int kJumps = effort(40, 10);
  int lost = 0;
  for (int i = 0; i < kJumps; ++i) {
    const Pose poses[2] = {met_at_random(gears.a.mesh, gears.b.mesh, 0.5 * Gears::kDelta, rng), {}};
    BakedScene scene = gears.scene();
    lost += tick_or_fail(*scene.engine, poses, {.units = 200}).contacts.empty() ? 1 : 0;
  }
  RecordProperty("lost", lost);
  EXPECT_LE(lost, kJumps / 20);
}

/// All of the tool is in a cell or two of the other body's grid: looks tell nothing of it, and
/// three of these jumps felt nothing.
TEST(RegionsBudget, after_a_jump_a_small_tool_finds_where_it_touches_a_large_body) {
  constexpr double kSize = 0.01;
  constexpr double kTouch = 0.01 * kSize;
  bake::BakeOptions options = options_for(bake::ForEngine::regions);
  options.delta_rel = 0.01;
  const BakedBody tool(gear(12, kSize, kSize), options);
  const BakedBody large(ball(24, 48, 1), options);
  std::mt19937 rng(5);
  constexpr int kJumps = effort(40, 10);
  int lost = 0;
  for (int i = 0; i < kJumps; ++i) {
    const Pose poses[2] = {met_at_random(tool.mesh, large.mesh, 0.5 * kTouch, rng), {}};
    BakedScene scene({tool.view, large.view}, {{0, 1}},
                     {.engine = EngineKind::regions, .delta_m = kTouch});
    lost += tick_or_fail(*scene.engine, poses, {.units = 300}).contacts.empty() ? 1 : 0;
  }
  RecordProperty("lost", lost);
  EXPECT_EQ(lost, 0);
}

/// What one tick has no time to find the next ones do: no budget is so small that what is held in
/// contact is never felt.
TEST(RegionsBudget, held_needles_are_found_to_touch_however_little_a_tick_has) {
  const Gears gears(60, 50);
  std::mt19937 rng(5);
  constexpr int kJumps = effort(8, 2);
  constexpr std::uint64_t kMostUnits = 4'000;  // of all ticks together
  std::uint64_t most = 0;
  for (int i = 0; i < kJumps; ++i) {
    const Pose poses[2] = {met_at_random(gears.a.mesh, gears.b.mesh, 0.5 * Gears::kDelta, rng), {}};
    for (const std::uint64_t units : {25u, 50u, 100u, 200u}) {
      BakedScene scene = gears.scene();
      std::uint64_t spent = units;
      while (spent < kMostUnits &&
             tick_or_fail(*scene.engine, poses, {.units = units}).contacts.empty()) {
        spent += units;
      }
      EXPECT_LT(spent, kMostUnits) << "jump " << i << ", " << units << " units";
      most = std::max(most, spent);
    }
  }
  RecordProperty("units", std::to_string(most));
}

/// A scout of a hundred units does not find where gears touch, and the next one would look at the
/// same places again: until they do, those that have been looked at in vain are passed over, and
/// what was nearly near enough is climbed from.
TEST(RegionsBudget, sliding_needles_are_found_to_touch_within_some_ticks) {
  const Gears gears(60, 50);
  std::mt19937 rng(5);
  constexpr int kSlides = effort(30, 6);
  int touching = 0, lost = 0;
  for (int i = 0; i < kSlides; ++i) {
    BakedScene exact = gears.scene();
    BakedScene budgeted = gears.scene();
    Slide slide(exact, rng);
    for (int t = 0; t < 20; ++t) {
      if (distance_at(exact, slide.pose) < Gears::kDelta) {
        ++touching;
        const Pose poses[2] = {slide.pose, {}};
        const TickResult r = tick_or_fail(*budgeted.engine, poses, {.units = 100});
        lost += r.contacts.empty() ? 1 : 0;
      }
      slide.go_on(0.2 * Gears::kDelta);
    }
  }
  RecordProperty("touching", touching);
  RecordProperty("lost", lost);
  EXPECT_GT(touching, 8 * kSlides);
  EXPECT_LT(7 * lost, touching);
}

/// Of what comes near, a tenth of delta a tick, a small budget may miss the first ticks, in which
/// there is hardly a force; what has been felt is not lost again.
TEST(RegionsBudget, needles_that_come_near_are_felt_before_they_are_deep_and_from_then_on) {
  constexpr double kStep = 0.1 * Gears::kDelta;
  constexpr double kDeep = 0.3;
  constexpr int kSlides = effort(30, 3);
  const Gears gears(60, 50);
  std::mt19937 rng(5);
  int touching = 0, late = 0, dropped = 0;
  double deepest = 0;
  for (int i = 0; i < kSlides; ++i) {
    BakedScene exact = gears.scene();
    BakedScene budgeted = gears.scene();
    Slide slide(exact, rng);
    slide.pose.position_m += 60 * kStep * slide.down;
    bool felt = false;
    for (int t = 0; t < 160; ++t) {
      const Pose poses[2] = {slide.pose, {}};
      const double depth = 1 - distance_at(exact, slide.pose) / Gears::kDelta;
      const bool felt_before = felt;
      felt = !tick_or_fail(*budgeted.engine, poses, {.units = 200}).contacts.empty();
      if (depth > 0) {
        ++touching;
        late += felt ? 0 : 1;
        dropped += felt_before && !felt ? 1 : 0;
        deepest = felt ? deepest : std::max(deepest, depth);
      }
      if (t < 60) {
        slide.pose.position_m -= kStep * slide.down;
      } else {
        slide.go_on(kStep);
      }
    }
  }
  RecordProperty("touching", touching);
  RecordProperty("late", late);
  RecordProperty("deepest", std::to_string(deepest));
  EXPECT_GT(touching, 40 * kSlides);
  EXPECT_EQ(dropped, 0);
  EXPECT_LT(deepest, kDeep);
}

/// Jaws pass each other by more than delta a tick and meet in places that have not touched before.
TEST(RegionsBudget, fast_passes_find_where_they_meet) {
  const Models jaws("jaw_upper", "jaw_lower", 24'000, 0.02);
  BakedScene exact = jaws.scene();
  BakedScene budgeted = jaws.scene();
  constexpr double kFeltWell = 0.8;  // of delta; farther contacts push little
  constexpr int kPasses = effort(400, 60);
  int touching = 0, lost = 0;
  for (int i = 0; i < kPasses; ++i) {
    Pose poses[2] = {ground(0.1, 10 * i), {}};
    poses[0].position_m.z += 1e-3;
    const TickResult truth = tick_or_fail(*exact.engine, poses);
    const TickResult found = tick_or_fail(*budgeted.engine, poses, {.units = 100});
    if (truth.contacts.empty() || truth.min_distance_m > kFeltWell * jaws.settings.delta_m)
      continue;
    ++touching;
    lost += found.contacts.empty() ? 1 : 0;
  }
  RecordProperty("touching", touching);
  RecordProperty("lost", lost);
  EXPECT_GT(touching, kPasses / 4);
  EXPECT_EQ(lost, 0);
}

TEST(RegionsBudget, every_budget_gives_a_true_certificate) {
  std::vector<double> forces;
  BakedScene exact = scene_with(kSettings);
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[2] = {motion(i), {}};
    forces.push_back(sum_of_forces(tick_or_fail(*exact.engine, poses)));
  }
  double last_mean = std::numeric_limits<double>::infinity();
  for (const std::uint64_t units : {0u, 1u, 10u, 50u, 200u, 1000u, 5000u, 100000u}) {
    BakedScene scene = scene_with(kSettings);
    double mean = 0;
    for (int i = 0; i < kTicks; ++i) {
      const Pose poses[2] = {motion(i), {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_EQ(r.certificate.units_used, r.queries);
      expect_certified(r, truth()[static_cast<std::size_t>(i)]);
      mean += r.certificate.error_bound_m / kTicks;
      if (truth()[static_cast<std::size_t>(i)] == 0) continue;  // depths are not covered
      EXPECT_LE(std::abs(sum_of_forces(r) - forces[static_cast<std::size_t>(i)]),
                r.certificate.force_bound_N + 0.05)
          << units << " units, tick " << i;
    }
    EXPECT_LE(mean, 1.05 * last_mean) << units << " units";
    last_mean = mean;
  }
  EXPECT_LT(last_mean, 1e-5);
}

/// Overlaps are looked at when searches have ended. (After a jump the old witnesses are measured
/// too, whatever the budget: no contact is lost for want of sixteen pairs.)
/// Some searches take more than a tick has room for, and are in vain where the next does not go on
/// with them: contacts are then missing however long nothing moves.
TEST(RegionsBudget, searches_longer_than_a_tick_end_while_nothing_moves) {
  BakedScene exact = scene_with(kSettings);
  BakedScene budgeted = scene_with(kSettings);
  const Pose poses[2] = {{{1.82, 0, 0}, {}}, {}};
  const TickResult truth = tick_or_fail(*exact.engine, poses);
  ASSERT_GT(truth.min_distance_m, 0);
  constexpr std::uint64_t kUnits = 40;
  constexpr std::uint64_t kMostTicks = 600;
  const double sum = sum_of_forces(truth);
  TickResult r;
  std::uint64_t ticks = 0;
  do {
    r = tick_or_fail(*budgeted.engine, poses, {.units = kUnits});
  } while (++ticks < kMostTicks && r.certificate.force_bound_N > 1e-3 * sum);
  RecordProperty("ticks", std::to_string(ticks));
  RecordProperty("units", std::to_string(truth.queries));
  EXPECT_LT(r.certificate.force_bound_N, 1e-3 * sum);
  EXPECT_NEAR(sum_of_forces(r), sum, 1e-3 * sum);
  EXPECT_EQ(r.contacts.size(), truth.contacts.size());
}

TEST(RegionsBudget, overlaps_take_no_more_than_a_batch_beyond_the_units) {
  constexpr int kUntilJump = 24;
  for (const std::uint64_t units : {0u, 10u, 200u, 1000u, 3000u}) {
    BakedScene scene = scene_with(kSettings);
    for (int i = 0; i < kUntilJump; ++i) {
      Pose deep = motion(i);
      deep.position_m.x -= 0.1;
      const Pose poses[2] = {deep, {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_LE(r.queries, units + regions::kBatchUnits) << units << " units, tick " << i;
    }
  }
}

TEST(RegionsBudget, force_tolerance_is_kept_and_saves_work) {
  BakedScene exact = scene_with(kSettings);
  for (const double tolerance_N : {3.0, 10.0, 30.0}) {
    Settings settings = kSettings;
    settings.exact = false;
    settings.force_tolerance_N = tolerance_N;
    BakedScene scene = scene_with(settings);
    std::uint64_t spent = 0;
    std::uint64_t spent_exactly = 0;
    for (int i = 0; i < kTicks; ++i) {
      const Pose poses[2] = {motion(i), {}};
      const TickResult r = tick_or_fail(*scene.engine, poses);
      EXPECT_FALSE(r.certificate.truncated());
      EXPECT_LE(r.certificate.force_bound_N, tolerance_N * (1 + 1e-6) + 0.05);
      spent += r.queries;
      spent_exactly += tick_or_fail(*exact.engine, poses).queries;
    }
    if (tolerance_N >= 10) {
      EXPECT_LT(spent, spent_exactly);
    }
  }
}

TEST(RegionsBudget, force_tolerance_hides_no_crossing) {
  BakedScene exact = scene_with(kSettings);
  Settings settings = kSettings;
  settings.exact = false;
  settings.force_tolerance_N = 30;
  BakedScene tolerant = scene_with(settings);
  int crossing = 0;
  for (int i = 0; i < 4 * kTicks; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const bool crosses = tick_or_fail(*exact.engine, poses).min_distance_m < 0;
    EXPECT_EQ(tick_or_fail(*tolerant.engine, poses).min_distance_m < 0, crosses) << i;
    if (crosses) ++crossing;
  }
  EXPECT_GT(crossing, kTicks / 4);
}

/// A body that rests on one with a force far above the tolerance comes near another one.
TEST(RegionsBudget, force_tolerance_hides_no_contact_of_any_pair) {
  const std::vector<ImageView> images = {bodies().a.view, bodies().b.view, bodies().b.view};
  const std::vector<BodyPair> pairs = {{0, 1}, {0, 2}};
  Settings tolerant_settings = kSettings;
  tolerant_settings.exact = false;
  tolerant_settings.force_tolerance_N = 4 * kSettings.stiffness_N_per_m * kDelta;
  BakedScene exact(images, pairs, kSettings);
  BakedScene tolerant(images, pairs, tolerant_settings);
  int touching[2] = {}, apart[2] = {};
  constexpr int kSlide = effort(240, 60);
  for (int i = 0; i < kSlide; ++i) {
    const double along = 4.0 * i / kSlide;
    const Pose poses[3] = {
        {{}, turn({0.6 * along, 0.24 * along, 0})},
        {{along < 2 ? 3 : 1.7, 0, 0}, {}},
        {{-1.81 - 0.04 * std::cos(9 * along), 0.02 * along, 0}, turn({0, 0.2 * along, 0})}};
    const TickResult truth = tick_or_fail(*exact.engine, poses);
    const TickResult found = tick_or_fail(*tolerant.engine, poses);
    EXPECT_EQ(found.certificate.contact, truth.certificate.contact) << i;
    EXPECT_NE(truth.certificate.contact, ContactStatus::undecided) << i;
    for (const std::uint32_t pair : {0u, 1u}) {
      const bool touches = contacts_of(truth, pair) > 0;
      EXPECT_EQ(contacts_of(found, pair) > 0, touches) << "tick " << i << ", pair " << pair;
      ++(touches ? touching : apart)[pair];
    }
  }
  for (const int pair : {0, 1}) {
    EXPECT_GT(touching[pair], kSlide / 4) << pair;
    EXPECT_GT(apart[pair], kSlide / 4) << pair;
  }
}

TEST(RegionsBudget, same_input_gives_the_same_bits) {
  for (const std::uint64_t units : {30u, 300u, 100000u}) {
    BakedScene one = scene_with(kSettings);
    BakedScene other = scene_with(kSettings);
    for (int i = 0; i < kTicks; ++i) {
      const Pose poses[2] = {motion(i), {}};
      const TickResult r = tick_or_fail(*one.engine, poses, {.units = units});
      const TickResult s = tick_or_fail(*other.engine, poses, {.units = units});
      ASSERT_EQ(std::memcmp(&r.wrench, &s.wrench, sizeof r.wrench), 0);
      ASSERT_EQ(r.contacts.size(), s.contacts.size());
      ASSERT_EQ(r.queries, s.queries);
    }
  }
}

TEST(RegionsBudget, cold_budget_is_no_worse_than_what_an_exact_cold_tick_has_reached) {
  for (const int start : {0, 10, 24, 40}) {
    const Pose poses[2] = {motion(start), {}};
    BakedScene exact = scene_with(kSettings);
    const TickResult whole = tick_or_fail(*exact.engine, poses);
    double last = std::numeric_limits<double>::infinity();
    for (const double share : {0.25, 0.5, 1.5}) {
      BakedScene scene = scene_with(kSettings);
      const auto units = static_cast<std::uint64_t>(share * double(whole.queries));
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_LE(r.certificate.force_bound_N, last);
      last = r.certificate.force_bound_N;
    }
  }
}

TEST(RegionsBudget, deadline_ends_refinement) {
  BakedScene scene = scene_with(kSettings);
  const Pose poses[2] = {motion(0), {}};
  CountingClock clock;
  const TickResult r =
      tick_or_fail(*scene.engine, poses,
                   {.clock_ns = CountingClock::read, .clock_context = &clock, .deadline_ns = 6});
  EXPECT_TRUE(r.certificate.truncated_by_time);
  EXPECT_LE(clock.now, 12u);
  expect_certified(r, truth()[0]);
}

TEST(RegionsBudget, counters_tell_where_ticks_spend_their_time_and_how_many_regions_are_searched) {
  BakedScene scene = scene_with(kSettings);
  if (counters(*scene.engine) == nullptr) GTEST_SKIP() << "this build counts nothing";
  CountingClock clock;
  constexpr std::uint64_t kLate = 1u << 30;
  std::uint64_t near = 0;
  for (int i = 0; i < 4; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const std::uint64_t begun = clock.now;
    near += tick_or_fail(
                *scene.engine, poses,
                {.clock_ns = CountingClock::read, .clock_context = &clock, .deadline_ns = kLate})
                .front_nodes;
    EXPECT_GT(clock.now, begun);
  }
  const Counters& c = *counters(*scene.engine);
  EXPECT_EQ(c.ticks, 4u);
  EXPECT_EQ(c.sweeps, 1u);
  EXPECT_EQ(c.near_regions, near);
  EXPECT_GT(c.searches, 0u);
  for (const Stage stage : {Stage::start, Stage::refine, Stage::settle, Stage::force}) {
    EXPECT_GT(c.stage_ns[static_cast<std::size_t>(stage)], 0u) << static_cast<int>(stage);
  }
  EXPECT_EQ(c.stage_ns[static_cast<std::size_t>(Stage::interpolate)], 0u);
}

TEST(RegionsBudget, deadlines_that_have_always_passed_do_not_hide_contacts_for_ever) {
  BakedScene scene = scene_with(kSettings);
  CountingClock clock;
  std::size_t found = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const TickResult r =
        tick_or_fail(*scene.engine, poses,
                     {.clock_ns = CountingClock::read, .clock_context = &clock, .deadline_ns = 0});
    EXPECT_TRUE(r.certificate.truncated_by_time);
    expect_certified(r, truth()[static_cast<std::size_t>(i)]);
    found = r.contacts.size();
  }
  EXPECT_GT(found, 0u);
}

TEST(RegionsBudget, few_contacts_are_a_reported_graceful_stop) {
  BakedScene scene = scene_with(kSettings, {.contacts = 1});
  bool met = false;
  for (int i = 0; i < 20; ++i) {
    const Pose poses[2] = {motion(i), {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    met |= r.certificate.truncated_by_memory;
    EXPECT_LE(r.contacts.size(), 1u);
  }
  EXPECT_TRUE(met);
}

TEST(RegionsBudget, every_region_has_room_for_its_contact_and_none_for_more) {
  Settings wide = kSettings;
  wide.delta_m = 4;
  BakedScene scene = scene_with(wide);
  const Pose poses[2] = {motion(0), {}};
  const TickResult r = tick_or_fail(*scene.engine, poses);
  EXPECT_EQ(r.contacts.size(), bodies().a.view.regions.size());
  EXPECT_FALSE(r.certificate.truncated_by_memory);
  const auto bytes = [&](std::uint32_t contacts) {
    return required_bytes(scene.scene(), {.contacts = contacts}, EngineKind::regions);
  };
  EXPECT_EQ(bytes(1u << 20), bytes(Limits{}.contacts));
}

TEST(RegionsRefusals, image_without_regions_is_refused) {
  const BakedBody levels_only(box(1, 1, 1));
  const std::vector<ImageView> views = {levels_only.view, bodies().b.view};
  const std::vector<BodyPair> pairs = {{0, 1}};
  const Scene scene{views, pairs, 0};
  AlignedMemory memory(required_bytes(scene, {}, EngineKind::regions));
  Engine* engine = nullptr;
  EXPECT_EQ(create(scene, kSettings, {}, memory.span(), engine), Status::image_missing_section);
}

TEST(RegionsRefusals, kind_of_engine_cannot_be_changed_between_ticks) {
  BakedScene scene = scene_with(kSettings);
  Settings other = kSettings;
  other.engine = EngineKind::levels;
  EXPECT_EQ(configure(*scene.engine, other), Status::bad_argument);
}

TEST(RegionsAllocationTrap, mixed_ticks_call_no_allocator_and_fault_no_page) {
  const BakedBody c(bowl(8, 16, 1.2), bake::ForEngine::regions);
  BakedScene scene({bodies().a.view, bodies().b.view, c.view}, {{0, 1}, {0, 2}}, kSettings);
  Pose poses[3];
  poses[2] = {{3.2, 0.1, 1}, turn({0, 1, 0})};
  const auto place = [&](int i) {
    poses[0] = motion(i);
    poses[0].position_m.x += 0.1 * std::sin(0.01 * i);  // parts and overlaps
    poses[0].position_m.z = 0.2 * std::cos(0.002 * i);
  };
  expect_no_allocation_and_no_fault(scene, poses, place, effort(700, 100), effort(5000, 500));
}

}  // namespace
}  // namespace palpate::test
