// SPDX-License-Identifier: GPL-3.0-or-later
// The region engine inside budgets: the certificate holds, nothing is lost, results repeat, memory
// stays alone.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "rt_core/counters.hpp"
#include "tests/support/allocation_trap.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/counting_clock.hpp"
#include "tests/support/effort.hpp"
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

std::ptrdiff_t contacts_of(const TickResult& r, std::uint32_t pair) {
  return std::count_if(r.contacts.begin(), r.contacts.end(),
                       [&](const Contact& c) { return c.pair == pair; });
}

TEST(RegionsBudget, every_budget_gives_a_true_certificate) {
  std::vector<Vec3d> forces;
  BakedScene exact = scene_with(kSettings);
  for (int i = 0; i < kTicks; ++i) {
    const Pose poses[2] = {motion(i), {}};
    forces.push_back(tick_or_fail(*exact.engine, poses).wrench.force_N);
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
      EXPECT_LE(norm(r.wrench.force_N - forces[static_cast<std::size_t>(i)]),
                r.certificate.force_bound_N + 1e-3)
          << units << " units, tick " << i;
    }
    EXPECT_LE(mean, 1.05 * last_mean) << units << " units";
    last_mean = mean;
  }
  EXPECT_LT(last_mean, 1e-5);
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
  for (const Stage stage : {Stage::start, Stage::refine, Stage::force}) {
    EXPECT_GT(c.stage_ns[static_cast<std::size_t>(stage)], 0u) << static_cast<int>(stage);
  }
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
  expect_no_allocation_and_no_fault(scene, poses, place, effort(50, 10), effort(350, 50));
}

}  // namespace
}  // namespace palpate::test
