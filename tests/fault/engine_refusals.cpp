// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine refuses, and scenes at their edges.
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

struct Boxes {
  BakedBody box_body{box(1, 1, 1)};
  std::vector<ImageView> two{box_body.view, box_body.view};
  std::vector<BodyPair> pair{{0, 1}};
};

const Boxes& boxes() {
  static const Boxes b;
  return b;
}

const Settings kSettings{.delta_m = 0.1, .cluster_radius_m = 0.1};

TEST(EngineCreate, scenes_out_of_range_need_no_memory_and_are_refused) {
  const Boxes& b = boxes();
  AlignedMemory memory(1 << 24);
  Engine* engine = nullptr;
  const std::vector<BodyPair> self{{0, 0}};
  const std::vector<BodyPair> beyond{{0, 2}};
  const std::vector<ImageView> blank(2);
  for (const Scene& scene :
       {Scene{{}, b.pair, 0}, Scene{b.two, {}, 0}, Scene{b.two, self, 0}, Scene{b.two, beyond, 0},
        Scene{b.two, b.pair, 2}, Scene{blank, b.pair, 0}}) {
    EXPECT_EQ(required_bytes(scene, {}), 0u);
    EXPECT_EQ(create(scene, kSettings, {}, memory.span(), engine), Status::bad_argument);
  }
  EXPECT_EQ(engine, nullptr);
}

TEST(EngineCreate, settings_out_of_range_are_refused) {
  const Boxes& b = boxes();
  const Scene scene{b.two, b.pair, 0};
  AlignedMemory memory(required_bytes(scene, {}));
  Engine* engine = nullptr;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const Settings& s :
       {Settings{.delta_m = 0}, Settings{.delta_m = -1}, Settings{.delta_m = nan},
        Settings{.delta_m = inf}, Settings{.s0 = -1}, Settings{.stiffness_N_per_m = nan},
        Settings{.cluster_radius_m = -1}, Settings{.max_force_N = nan}}) {
    EXPECT_EQ(create(scene, s, {}, memory.span(), engine), Status::bad_argument);
  }
}

TEST(EngineCreate, one_byte_too_few_or_misaligned_memory_is_refused) {
  const Boxes& b = boxes();
  const Scene scene{b.two, b.pair, 0};
  const std::size_t need = required_bytes(scene, {});
  AlignedMemory memory(need + 64);
  Engine* engine = nullptr;
  EXPECT_EQ(create(scene, kSettings, {}, memory.span().first(need - 1), engine),
            Status::not_enough_memory);
  EXPECT_EQ(create(scene, kSettings, {}, memory.span().subspan(8, need), engine),
            Status::not_enough_memory);
  EXPECT_EQ(create(scene, kSettings, {}, memory.span().first(need), engine), Status::ok);
}

TEST(EngineTick, bad_poses_are_refused_and_leave_the_engine_usable) {
  const Boxes& b = boxes();
  BakedScene scene(b.two, b.pair, kSettings);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TickResult r;
  const Pose fine[2] = {{{2.05, 0, 0}, {}}, {}};
  for (const Pose& bad :
       {Pose{{nan, 0, 0}, {}}, Pose{{0, 0, std::numeric_limits<double>::infinity()}, {}},
        Pose{{}, {0, 0, 0, 0}}, Pose{{}, {1.01, 0, 0, 0}}, Pose{{}, {nan, 0, 0, 0}}}) {
    const Pose poses[2] = {bad, {}};
    EXPECT_EQ(tick(*scene.engine, poses, {}, r), Status::bad_pose);
  }
  EXPECT_EQ(tick(*scene.engine, std::span(fine).first(1), {}, r), Status::bad_argument);
  ASSERT_EQ(tick(*scene.engine, fine, {}, r), Status::ok);
  ASSERT_FALSE(r.contacts.empty());
  EXPECT_NEAR(r.min_distance_m, 0.05, 1e-6);
  EXPECT_NEAR(r.contacts[0].normal.x, 1, 1e-6);
}

TEST(EngineTick, box_pressed_into_a_box_is_pushed_out_by_its_depth) {
  const Boxes& b = boxes();
  BakedScene scene(b.two, b.pair, kSettings);
  for (const double depth : {1e-4, 0.01, 0.3}) {
    const Pose poses[2] = {{{2 - depth, 0.1, 0.05}, {}}, {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    ASSERT_FALSE(r.contacts.empty());
    EXPECT_NEAR(r.min_distance_m, -depth, 1e-5);
    EXPECT_NEAR(r.wrench.force_N.x, 600 * (0.1 + depth), 1e-2);
    EXPECT_NEAR(r.wrench.force_N.y, 0, 1e-2);
  }
}

TEST(EngineTick, distance_is_continuous_through_touching) {
  const Boxes& b = boxes();
  BakedScene scene(b.two, b.pair, kSettings);
  double last = std::numeric_limits<double>::quiet_NaN();
  for (int i = -50; i <= 50; ++i) {
    const double gap = 1e-7 * i * std::abs(i);
    const Pose poses[2] = {{{2 + gap, 0.1, 0.05}, {}}, {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    ASSERT_FALSE(r.contacts.empty());
    EXPECT_NEAR(r.min_distance_m, gap, 1e-6);
    EXPECT_GT(r.wrench.force_N.x, 0);
    if (i > -50) {
      EXPECT_NEAR(r.wrench.force_N.x, last, 600 * 2.2e-5);
    }
    last = r.wrench.force_N.x;
  }
}

TEST(EngineTick, many_bodies_and_pairs_sum_on_the_tool) {
  const Boxes& b = boxes();
  const std::vector<ImageView> five(5, b.box_body.view);
  const std::vector<BodyPair> pairs{{0, 1}, {2, 0}, {0, 3}, {3, 4}};
  BakedScene scene(five, pairs, kSettings);
  // The tool in the middle: one neighbour to the right, one to the left, one above; a fifth box
  // only touches the third.
  const Pose poses[5] = {
      {}, {{2.05, 0, 0}, {}}, {{-2.02, 0, 0}, {}}, {{0, 2.04, 0}, {}}, {{0, 4.08, 0}, {}}};
  const TickResult r = tick_or_fail(*scene.engine, poses);
  EXPECT_NEAR(r.wrench.force_N.x, 600 * (0.08 - 0.05), 1e-2);
  EXPECT_NEAR(r.wrench.force_N.y, -600 * 0.06, 1e-2);
  EXPECT_EQ(r.clusters, 3u);
}

TEST(EngineTick, far_bodies_cost_nothing) {
  const Boxes& b = boxes();
  BakedScene scene(b.two, b.pair, kSettings);
  const Pose poses[2] = {{{1e6, -1e6, 1e6}, {}}, {}};
  const TickResult r = tick_or_fail(*scene.engine, poses);
  EXPECT_TRUE(r.contacts.empty());
  EXPECT_EQ(r.queries, 0u);
  EXPECT_TRUE(std::isnan(r.min_distance_m));
  EXPECT_EQ(norm(r.wrench.force_N), 0);
}

}  // namespace
}  // namespace palpate::test
