// SPDX-License-Identifier: GPL-3.0-or-later
// One body wholly inside another: no triangles cross, and yet they overlap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "host_bake/models/models.hpp"
#include "rt_core/engine.hpp"
#include "tests/support/answers.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"
#include "tests/unit/mesh_support.hpp"

namespace palpate::test {
namespace {

constexpr bake::ForEngine kRegions = bake::ForEngine::regions;
constexpr double kDelta = 0.02;

Settings settings() {
  return {
      .engine = EngineKind::regions, .delta_m = kDelta, .exact = true, .cluster_radius_m = kDelta};
}

using bake::testing::inside_out;
using bake::testing::together;

bake::Mesh shifted(bake::Mesh mesh, Vec3d by) {
  for (bake::Point& p : mesh.points) p = {p[0] + by.x, p[1] + by.y, p[2] + by.z};
  return mesh;
}

struct Small {
  BakedBody body{ball(8, 10, 0.1), kRegions};
};

TickResult tick_at(BakedScene& scene, Vec3d at) {
  const Pose poses[2] = {{at, {}}, {}};
  return tick_or_fail(*scene.engine, poses);
}

void expect_pushed_out(const TickResult& r, Vec3d out) {
  ASSERT_FALSE(r.contacts.empty());
  EXPECT_LT(r.min_distance_m, 0);
  EXPECT_GT(dot(r.wrench.force_N, out), 0);
  for (const Contact& c : r.contacts) EXPECT_NEAR(norm(c.normal), 1, 1e-6);
}

TEST(RegionsContained, small_body_inside_a_large_one_is_pushed_out_the_nearest_way) {
  const Small small;
  const BakedBody large(box(1, 1, 1), kRegions);
  BakedScene scene({small.body.view, large.view}, {{0, 1}}, settings());
  for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}}) {
    const Vec3d aside{0.02, 0.03, 0.01};
    expect_pushed_out(tick_at(scene, 0.7 * axis + aside), axis);    // deep: nothing within delta
    expect_pushed_out(tick_at(scene, 0.885 * axis + aside), axis);  // just below the surface
    EXPECT_TRUE(tick_at(scene, 1.5 * axis + aside).contacts.empty());
  }
}

/// A ray through a body may take more units than a tick has, and what it has told is asked again
/// as the bodies move: the way out stays known meanwhile.
TEST(RegionsContained, small_budget_does_not_rule_out_what_it_has_no_time_to_look_for) {
  const BakedBody small(gear(12, 0.1, 0.05), kRegions);
  const BakedBody large(gear(40, 1, 0.6), kRegions);
  constexpr int kTicks = 50;
  constexpr std::uint64_t kFewest = 64;  // units of one vertex that is deep inside, and some more
  for (const std::uint64_t units : {1u, 4u, 16u, 32u, 64u, 128u, 256u}) {
    BakedScene scene({small.view, large.view}, {{0, 1}}, settings());
    int found = 0;
    int lost = 0;
    for (int i = 0; i < kTicks; ++i) {
      const Pose poses[2] = {{{0.4, 0.03, 1e-4 * i}, {}}, {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_NE(r.certificate.contact, ContactStatus::ruled_out) << units;
      found += r.contacts.empty() ? 0 : 1;
      lost += r.contacts.empty() && found > 0 ? 1 : 0;
    }
    EXPECT_EQ(lost, 0) << units;
    if (units >= kFewest) {
      EXPECT_GT(found, kTicks / 2) << units;
    }
  }
}

TEST(RegionsContained, what_was_asked_before_a_jump_does_not_tell_where_a_body_is_after_it) {
  const BakedBody small(gear(12, 0.1, 0.05), kRegions);
  const BakedBody large(gear(40, 1, 0.6), kRegions);
  for (const std::uint64_t units : {16u, 64u, 256u}) {
    for (int asked = 1; asked < 8; ++asked) {
      BakedScene scene({small.view, large.view}, {{0, 1}}, settings());
      const Pose inside[2] = {{{0.4, 0.03, 0}, {}}, {}};
      const Pose outside[2] = {{{0.8, 0.03, 0}, {}}, {}};
      for (int i = 0; i < asked; ++i) tick_or_fail(*scene.engine, inside, {.units = 16});
      EXPECT_TRUE(tick_or_fail(*scene.engine, outside, {.units = units}).contacts.empty());
    }
  }
}

/// What moves by more than it is wide may be on either side, with no tick in which it crosses.
TEST(RegionsContained, what_passes_through_a_surface_between_two_ticks_is_inside) {
  const BakedBody small(ball(8, 10, 0.01), kRegions);
  const BakedBody large(box(1, 1, 1), kRegions);
  Settings thin = settings();
  thin.delta_m = 0.002;
  for (const std::uint64_t units : {Budget{}.units, std::uint64_t{500}, std::uint64_t{100}}) {
    BakedScene scene({small.view, large.view}, {{0, 1}}, thin);
    for (int i = 0; i < 20; ++i) {
      const double z = 1.2 - 0.031 * (i < 12 ? i : 24 - i);
      const Pose poses[2] = {{{0.02, 0.03, z}, {}}, {}};
      const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
      EXPECT_EQ(r.certificate.contact == ContactStatus::found, z < 1) << z << " with " << units;
    }
  }
}

/// Ways through each other, with steps from a tenth of delta to what counts as a jump, against
/// exact answers that know nothing of the tick before.
void expect_no_way_is_denied(const std::vector<BakedBody>& small,
                             const std::vector<BakedBody>& large, int ways) {
  constexpr double kThin = 0.004;
  Settings thin = settings();
  thin.delta_m = kThin;
  struct Count {
    std::uint64_t units;
    int denied = 0, missed = 0, made_up = 0;
  };
  Count counts[] = {{Budget{}.units}, {2000}, {300}, {60}};
  int contained = 0;
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> from_0_to_1;
  Settings distances = thin;
  distances.stiffness_N_per_m = 0;
  thin.exact = false;
  const auto tick_of = [&](int way) {
    const BakedBody& a = small[std::size_t(way) % small.size()];
    const BakedBody& b = large[std::size_t(way) / small.size() % large.size()];
    const auto scene = [&] { return BakedScene({a.view, b.view}, {{0, 1}}, thin); };
    std::vector<BakedScene> scenes;
    while (scenes.size() < std::size(counts)) scenes.push_back(scene());
    const double length = kThin * std::pow(10, -1 + 2.2 * from_0_to_1(rng));
    const Vec3d step = length * random_unit(rng);
    const Quat turned = turn(length * from_0_to_1(rng) * random_unit(rng));
    const double from_centre = b.view.header->radius_m * (0.5 + 0.6 * from_0_to_1(rng));
    Pose pose{from_centre * random_unit(rng), turn(3.0 * random_unit(rng))};
    constexpr int kTicks = 40;
    pose.position_m -= 0.5 * kTicks * step;
    for (int t = 0; t < kTicks; ++t) {
      const Pose poses[2] = {pose, {}};
      const TickResult truth =
          tick_or_fail(*BakedScene({a.view, b.view}, {{0, 1}}, distances).engine, poses);
      const bool touches = !truth.contacts.empty();
      const double distance = !touches ? kThin : std::max(0.0, truth.min_distance_m);
      contained += touches && truth.min_distance_m < -kThin ? 1 : 0;
      for (std::size_t k = 0; k < scenes.size(); ++k) {
        Count& count = counts[k];
        const TickResult r = tick_or_fail(*scenes[k].engine, poses, {.units = count.units});
        expect_certified(r, distance, kThin);
        if (!r.contacts.empty()) {
          EXPECT_LE(std::abs(std::max(0.0, r.min_distance_m) - distance),
                    r.certificate.error_bound_m + 2e-6);
        }
        count.denied += touches && r.certificate.contact == ContactStatus::ruled_out ? 1 : 0;
        count.missed += touches && r.contacts.empty() ? 1 : 0;
        count.made_up += !touches && !r.contacts.empty() ? 1 : 0;
      }
      pose.position_m += step;
      pose.orientation = turned * pose.orientation;
    }
  };
  for (int way = 0; way < ways; ++way) tick_of(way);
  testing::Test::RecordProperty("contained", contained);
  EXPECT_GT(contained, 10 * ways);
  for (const Count& c : counts) {
    testing::Test::RecordProperty("missed_" + std::to_string(c.units), c.missed);
    testing::Test::RecordProperty("made_up_" + std::to_string(c.units), c.made_up);
    EXPECT_EQ(c.denied, 0) << c.units;
    if (c.units >= 2000) {
      EXPECT_EQ(c.missed, 0) << c.units;
      EXPECT_EQ(c.made_up, 0) << c.units;
    }
  }
}

TEST(RegionsContained, no_way_in_is_denied_and_no_way_out) {
  std::vector<BakedBody> large;
  large.emplace_back(bumpy_ball(24, 30, 1), kRegions);
  large.emplace_back(gear(12, 1, 0.4), kRegions);
  large.emplace_back(bake::make_model("golf_shell", 4'000), kRegions);
  std::vector<BakedBody> small;
  small.emplace_back(ball(6, 8, 0.01), kRegions);
  small.emplace_back(gear(6, 0.04, 0.02), kRegions);
  small.emplace_back(bumpy_ball(10, 12, 0.2), kRegions);
  expect_no_way_is_denied(small, large, effort(90, 9));
}

TEST(RegionsContained, no_way_of_one_component_among_several_is_denied) {
  std::vector<BakedBody> large;
  large.emplace_back(together(bumpy_ball(24, 30, 1), inside_out(ball(12, 16, 0.6))), kRegions);
  large.emplace_back(together(gear(12, 0.5, 0.4), shifted(box(0.5, 0.4, 0.4), {0, 1.2, 0})),
                     kRegions);
  std::vector<BakedBody> small;
  small.emplace_back(together(ball(6, 8, 0.01), shifted(ball(6, 8, 0.012), {0, 0, 0.4})), kRegions);
  small.emplace_back(ball(6, 8, 0.02), kRegions);
  small.emplace_back(together(gear(6, 0.04, 0.02), shifted(ball(4, 6, 0.02), {0.1, 0.02, 0})),
                     kRegions);
  expect_no_way_is_denied(small, large, effort(60, 6));
}

TEST(RegionsContained, large_body_around_a_small_one_is_pushed_off_it) {
  const Small small;
  const BakedBody large(box(1, 1, 1), kRegions);
  BakedScene scene({large.view, small.body.view}, {{0, 1}}, settings());
  expect_pushed_out(tick_at(scene, {0.7, 0.02, 0.03}), {1, 0, 0});
}

TEST(RegionsContained, slow_way_in_is_noticed_and_the_way_out_too) {
  const Small small;
  const BakedBody large(box(1, 1, 1), kRegions);
  BakedScene scene({small.body.view, large.view}, {{0, 1}}, settings());
  for (double z = 1.13; z > 0.6; z -= 0.005) {
    const TickResult r = tick_at(scene, {0.02, 0.03, z});
    if (z < 1.09) {
      ASSERT_FALSE(r.contacts.empty()) << z;
      EXPECT_GT(r.wrench.force_N.z, 0) << z;
    }
  }
  for (double z = 0.6; z < 1.13; z += 0.005) {
    const TickResult r = tick_at(scene, {0.02, 0.03, z});
    if (z < 1.09) {
      ASSERT_FALSE(r.contacts.empty()) << z;
      EXPECT_GT(r.wrench.force_N.z, 0) << z;
    }
  }
  EXPECT_GT(tick_at(scene, {0.02, 0.03, 1.115}).min_distance_m, 0);
}

TEST(RegionsContained, rooms_and_open_surfaces_have_no_inside) {
  const Small small;
  const BakedBody room(inside_out(box(1, 1, 1)), kRegions);
  const BakedBody open(bowl(8, 16, 1.2), kRegions);
  for (const BakedBody* around : {&room, &open}) {
    BakedScene scene({small.body.view, around->view}, {{0, 1}}, settings());
    EXPECT_TRUE(tick_at(scene, {0.02, 0.03, 0.01}).contacts.empty());
  }
}

TEST(RegionsContained, wall_of_a_shell_is_inside_and_its_cavity_is_not) {
  const BakedBody small(ball(6, 8, 0.04), kRegions);
  const BakedBody around(together(ball(12, 16, 1), inside_out(ball(12, 16, 0.7))), kRegions);
  BakedScene scene({small.view, around.view}, {{0, 1}}, settings());
  EXPECT_TRUE(tick_at(scene, {0.02, 0.03, 0.01}).contacts.empty());
  expect_pushed_out(tick_at(scene, {0.9, 0.01, 0.02}), {1, 0, 0});
  expect_pushed_out(tick_at(scene, {0.78, 0.01, 0.02}), {-1, 0, 0});
}

/// Two balls and a bar beside them, in one body: whichever of them is inside the box.
TEST(RegionsContained, component_of_a_body_is_pushed_out_by_itself) {
  const Vec3d at[] = {{0, 0, 0}, {3, 0, 0}, {-3, 0, 0.02}};
  const bake::Mesh balls =
      together(shifted(ball(8, 10, 0.1), at[0]), shifted(ball(6, 8, 0.12), at[1]));
  const BakedBody parts(together(balls, shifted(box(0.1, 0.4, 0.1), at[2])), kRegions);
  const BakedBody large(box(1, 1, 1), kRegions);
  ASSERT_EQ(parts.view.header->source_components, 3u);
  for (const std::uint64_t units : {Budget{}.units, std::uint64_t{1000}}) {
    for (const Vec3d inside : at) {
      for (const bool parts_move : {true, false}) {
        SCOPED_TRACE(std::to_string(units) + " units, " + std::to_string(inside.x) +
                     (parts_move ? ", moving" : ", still"));
        const ImageView views[] = {parts.view, large.view};
        BakedScene scene({views[parts_move ? 0 : 1], views[parts_move ? 1 : 0]}, {{0, 1}},
                         settings());
        const auto tick = [&](Vec3d component_at) {
          const Vec3d aside = component_at - inside;
          const Pose poses[2] = {{parts_move ? aside : -aside, {}}, {}};
          return tick_or_fail(*scene.engine, poses, {.units = units});
        };
        TickResult r = tick({0.02, 0.03, 0.7});
        for (int i = 0; i < 3; ++i) r = tick({0.02, 0.03, 0.7});
        expect_pushed_out(r, {0, 0, parts_move ? 1.0 : -1.0});
        EXPECT_NEAR(r.min_distance_m, -0.3, 0.13);  // between its nearest and its deepest vertex
        EXPECT_TRUE(tick({0.02, 0.03, 1.5}).contacts.empty());
      }
    }
  }
}

TEST(RegionsContained, component_beside_the_one_inside_stays_outside) {
  const bake::Mesh inner = shifted(ball(8, 10, 0.1), {0, 0, -0.9});
  for (const bool inner_first : {true, false}) {
    const bake::Mesh outer = ball(8, 10, 0.1);
    const BakedBody parts(inner_first ? together(inner, outer) : together(outer, inner), kRegions);
    const BakedBody large(box(1, 1, 1), kRegions);
    BakedScene scene({parts.view, large.view}, {{0, 1}}, settings());
    const TickResult r = tick_at(scene, {0.02, 0.03, 1.1 + 0.5 * kDelta});
    int outside = 0;
    int inside = 0;
    for (const Contact& c : r.contacts) {
      outside += c.distance_m > 0 && c.centre_m.z > 1 ? 1 : 0;
      inside += c.distance_m < -kDelta && c.centre_m.z < 1 ? 1 : 0;
    }
    EXPECT_GT(outside, 0);
    EXPECT_GT(inside, 0);
    EXPECT_EQ(static_cast<std::size_t>(outside + inside), r.contacts.size());
  }
}

/// The bottom of a box that is pressed into a block crosses nothing.
TEST(RegionsContained, block_that_crosses_itself_elsewhere_has_an_inside) {
  constexpr double kDeep = 0.5 * kDelta;
  const BakedBody tool(quartered(box(0.1, 0.1, 0.1), 3), kRegions);
  bake::Mesh mesh = quartered(box(1, 1, 1), 4);
  for (bake::Point& p : mesh.points) {
    if (p == bake::Point{0.5, 0.5, -1}) p[2] = 1.2;  // through the upper side
  }
  const BakedBody block(std::move(mesh), kRegions);
  ASSERT_NE(block.view.header->source_crossings, 0u);
  BakedScene scene({tool.view, block.view}, {{0, 1}}, settings());
  for (const Vec3d at : {Vec3d{-0.51, -0.52, 1.1}, Vec3d{-0.73, 0.13, 1.1}}) {
    const Pose in[2] = {{at - Vec3d{0, 0, kDeep}, turn({0.01, 0.02, 0.3})}, {}};
    const TickResult inside = tick_or_fail(*scene.engine, in);
    ASSERT_GT(inside.contacts.size(), 4u);
    EXPECT_GT(inside.wrench.force_N.z, 0);
    const Pose out[2] = {{at + Vec3d{0, 0, kDeep}, turn({0.01, 0.02, 0.3})}, {}};
    const TickResult outside = tick_or_fail(*scene.engine, out);
    ASSERT_FALSE(outside.contacts.empty());
    for (const Contact& c : outside.contacts) EXPECT_GT(c.distance_m, 0);
    EXPECT_GT(outside.wrench.force_N.z, 0);
  }
}

}  // namespace
}  // namespace palpate::test
