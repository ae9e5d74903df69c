// SPDX-License-Identifier: GPL-3.0-or-later
// Selective refinement on simplified levels: certificates, settings, and images that hold only what
// a scene requires.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "host_bake/models/models.hpp"
#include "tests/support/answers.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/coarse_bodies.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"

namespace palpate::test {
namespace {

Pose slide(int i) {
  return {{1.85 + 0.02 * std::sin(0.2 * i), 0.3 * std::sin(0.03 * i), 0.004 * i},
          turn({0.01 * i, 0.004 * i, 0})};
}

Settings with_s0(double s0) { return {.delta_m = kDelta, .s0 = s0, .cluster_radius_m = 0.1}; }

TEST(EngineLevels, bodies_have_several_simplified_levels) {
  for (const ImageView* image : {&bodies().a.view, &bodies().b.view})
    EXPECT_GE(image->levels.size() - image->header->free_levels, 4u);
}

TEST(EngineLevels, certificate_holds_whatever_is_left_out) {
  const std::vector<double> truth = distances_along(bodies().a.mesh, bodies().b.mesh, slide, 30);
  for (const double s0 : {0.0, 1e-3, 0.01, 0.05, 0.5, 1e3}) {
    for (const std::uint64_t units : {3u, 30u, 300u, 1000000u}) {
      BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, with_s0(s0));
      for (int i = 0; i < 30; ++i) {
        const Pose poses[2] = {slide(i), {}};
        const TickResult r = tick_or_fail(*scene.engine, poses, {.units = units});
        EXPECT_LE(r.queries, units);
        expect_certified(r, truth[static_cast<std::size_t>(i)], kDelta);
      }
    }
  }
}

// Neighbouring pieces are often equally near, by a vertex that they share: rounding, other in every
// place, must not decide what is felt of them.
TEST(EngineLevels, wrench_turns_with_the_world_where_every_tick_is_a_jump) {
  BakedScene one({bodies().a.view, bodies().b.view}, {{0, 1}}, with_s0(0.025));
  BakedScene other({bodies().a.view, bodies().b.view}, {{0, 1}}, with_s0(0.025));
  std::mt19937 rng(5);
  expect_wrench_turns_with_the_world(one, other, 300, [&](int i) {
    const Vec3d direction = random_unit(rng);
    return Pose{(1.8 + 0.0002 * i) * direction, turn(3.0 * random_unit(rng))};
  });
}

/// An ellipsoid slides and rolls over a golf ball, 0.4 delta above it.
std::vector<Pose> rolled(const BakedBody& ellipsoid, const BakedBody& ball, double delta_m) {
  constexpr double kApart_m = 0.0414;
  BakedScene wide({ellipsoid.view, ball.view}, {{0, 1}},
                  {.delta_m = 0.006, .exact = true, .stiffness_N_per_m = 0});
  std::vector<Pose> path;
  for (int i = 0; i < effort(400, 40); ++i) {
    const double u = 0.0035 * i;
    const double level = std::cos(0.3 * u);
    const Vec3d out{std::cos(u) * level, std::sin(u) * level, std::sin(0.3 * u)};
    Pose pose{kApart_m * out, turn({0.6 * std::sin(0.5 * u), u, 0.4 * u})};
    for (int k = 0; k < 40; ++k) {
      const Pose poses[2] = {pose, {}};
      const TickResult r = tick_or_fail(*wide.engine, poses);
      pose.position_m -= ((r.contacts.empty() ? 0.006 : r.min_distance_m) - 0.4 * delta_m) * out;
    }
    path.push_back(pose);
  }
  return path;
}

TEST(EngineLevels, contact_is_not_lost_where_pieces_of_several_levels_meet) {
  constexpr double kDelta_m = 0.0008;
  const BakedBody ellipsoid(bake::make_model("ellipsoid", 1000));
  const BakedBody ball(bake::make_model("golf_ball", 4000));
  const std::vector<Pose> path = rolled(ellipsoid, ball, kDelta_m);
  BakedScene scene({ellipsoid.view, ball.view}, {{0, 1}}, {.delta_m = kDelta_m, .s0 = 0.05});
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Pose poses[2] = {path[i], {}};
    EXPECT_FALSE(tick_or_fail(*scene.engine, poses).contacts.empty()) << "tick " << i;
  }
}

TEST(EngineLevels, threshold_of_zero_is_exact) {
  BakedScene selective({bodies().a.view, bodies().b.view}, {{0, 1}}, with_s0(0));
  Settings settings = with_s0(0);
  settings.exact = true;
  BakedScene exact({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  for (int i = 0; i < 30; ++i) {
    const Pose poses[2] = {slide(i), {}};
    const TickResult s = tick_or_fail(*selective.engine, poses);
    const TickResult e = tick_or_fail(*exact.engine, poses);
    EXPECT_EQ(pairs_of(s), pairs_of(e)) << i;
    ASSERT_EQ(s.contacts.empty(), e.contacts.empty()) << i;
    if (!e.contacts.empty()) {
      EXPECT_NEAR(s.min_distance_m, e.min_distance_m, 1e-9);
    }
    EXPECT_NEAR(norm(s.wrench.force_N - e.wrench.force_N), 0, 1e-6 * (1 + norm(e.wrench.force_N)));
  }
}

TEST(EngineLevels, larger_thresholds_need_smaller_fronts) {
  double last = std::numeric_limits<double>::infinity();
  for (const double s0 : {0.0, 0.01, 0.1, 1.0}) {
    BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, with_s0(s0));
    double front = 0;
    for (int i = 0; i < 20; ++i) {
      const Pose poses[2] = {slide(i), {}};
      front += static_cast<double>(tick_or_fail(*scene.engine, poses).front_nodes);
    }
    EXPECT_LE(front, last) << s0;
    last = front;
  }
}

TEST(EngineLevels, kappa_bounds_the_deviation_that_is_left) {
  Settings settings = with_s0(1e3);
  for (const double kappa : {0.1, 0.5, 2.0}) {
    settings.kappa = kappa;
    BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
    for (int i = 0; i < 10; ++i) {
      const Pose poses[2] = {slide(i), {}};
      for (const Contact& c : tick_or_fail(*scene.engine, poses).contacts) {
        EXPECT_LE(static_cast<double>(bodies().a.view.pieces[c.piece_a].surface_deviation) *
                      bodies().a.view.header->radius_m,
                  kappa * kDelta * 1.000001);
        EXPECT_LE(static_cast<double>(bodies().b.view.pieces[c.piece_b].surface_deviation) *
                      bodies().b.view.header->radius_m,
                  kappa * kDelta * 1.000001);
      }
    }
  }
}

TEST(EngineLevels, exact_contacts_are_the_same_with_either_bounds) {
  Settings settings = with_s0(0);
  settings.exact = true;
  BakedScene tight({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  settings.bounds = Bounds::paper;
  BakedScene paper({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  for (int i = 0; i < 30; ++i) {
    const Pose poses[2] = {slide(i), {}};
    const TickResult t = tick_or_fail(*tight.engine, poses);
    EXPECT_EQ(pairs_of(t), pairs_of(tick_or_fail(*paper.engine, poses)));
  }
}

// The cut of a tick is that of a cold start at the same pose.
TEST(EngineLevels, contacts_do_not_depend_on_history) {
  BakedScene warm({bodies().a.view, bodies().b.view}, {{0, 1}}, with_s0(0.02));
  for (int i = 0; i < 25; ++i) {
    const Pose poses[2] = {slide(i), {}};
    const TickResult w = tick_or_fail(*warm.engine, poses);
    BakedScene cold({bodies().a.view, bodies().b.view}, {{0, 1}}, with_s0(0.02));
    const TickResult c = tick_or_fail(*cold.engine, poses);
    EXPECT_EQ(w.contacts.empty(), c.contacts.empty());
    if (w.contacts.empty() || c.contacts.empty()) continue;
    const double bound = w.certificate.error_bound_m + c.certificate.error_bound_m;
    EXPECT_LE(std::abs(w.min_distance_m - c.min_distance_m), bound);
  }
}

// Closer and closer in steps so small, and at one place, that only a change of level can make the
// force jump. It ends well apart: where edges nearly touch normals turn fast.
double largest_jump(double s0) {
  Settings settings = with_s0(s0);
  settings.cluster_radius_m = 10;
  BakedScene scene({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
  double last = 0, largest = 0;
  for (int i = 0; i < 850; ++i) {
    const Pose poses[2] = {{{1.95 - 1e-4 * i, 0.1, 0.05}, turn({0.3, 0.2, 2e-4 * i})}, {}};
    const double force = norm(tick_or_fail(*scene.engine, poses).wrench.force_N);
    if (i > 0) largest = std::max(largest, std::abs(force - last));
    last = force;
  }
  return largest;
}

TEST(EngineLevels, force_hardly_jumps_where_a_level_changes) {
  const Settings settings = with_s0(0.05);
  EXPECT_LT(largest_jump(0.05), 0.1 * settings.stiffness_N_per_m * settings.delta_m);
}

/// The same body without its finest levels.
BakedBody pruned(double partner_area = 0) {
  bake::BakeOptions options = coarse();
  options.max_bytes = static_cast<std::size_t>(bodies().a.view.header->total_bytes / 2);
  options.partner_area = partner_area;
  return BakedBody(bumpy_ball(24, 32, 1), options);
}

using Row = std::tuple<double, double, double, double, double, double, double>;

Row row_of(const TickResult& r) {
  const Vec3d f = r.wrench.force_N, t = r.wrench.torque_Nm;
  return {f.x, f.y, f.z, t.x, t.y, t.z, r.contacts.empty() ? -1.0 : r.min_distance_m};
}

TEST(EngineLevels, image_without_its_finest_levels_gives_the_same_bits_within_its_promise) {
  const BakedBody small = pruned();
  const image::Header& header = *small.view.header;
  ASSERT_GT(header.dropped_levels, 0u);
  const auto s0 = static_cast<double>(header.s0_min);
  for (const std::uint64_t units : {40u, 1000000u}) {
    const Settings settings = with_s0(s0);
    BakedScene whole({bodies().a.view, bodies().b.view}, {{0, 1}}, settings);
    BakedScene part({small.view, bodies().b.view}, {{0, 1}}, settings);
    for (int i = 0; i < 40; ++i) {
      const Pose poses[2] = {slide(i), {}};
      const TickResult w = tick_or_fail(*whole.engine, poses, {.units = units});
      const TickResult p = tick_or_fail(*part.engine, poses, {.units = units});
      ASSERT_EQ(row_of(w), row_of(p)) << "tick " << i << ", " << units << " units";
    }
  }
}

TEST(EngineLevels, scene_beyond_an_images_promise_is_refused) {
  const BakedBody small = pruned();
  const auto s0 = static_cast<double>(small.view.header->s0_min);
  const ImageView images[2] = {small.view, bodies().b.view};
  const BodyPair pairs[1] = {{0, 1}};
  const Scene scene{images, pairs, 0};
  const AlignedMemory memory(required_bytes(scene, {}));
  Engine* engine = nullptr;
  Settings settings = with_s0(s0);
  EXPECT_EQ(create(scene, settings, {}, memory.span(), engine), Status::ok);
  settings.s0 = 0.5 * s0;
  EXPECT_EQ(create(scene, settings, {}, memory.span(), engine), Status::image_too_coarse);
  EXPECT_EQ(configure(*engine, settings), Status::image_too_coarse);
  settings = with_s0(s0);
  settings.exact = true;
  EXPECT_EQ(configure(*engine, settings), Status::image_too_coarse);
  settings = with_s0(s0);
  settings.kappa = 1e-3;
  EXPECT_EQ(configure(*engine, settings), Status::image_too_coarse);
  settings.kappa = 1e3;
  EXPECT_EQ(configure(*engine, settings), Status::ok);
}

TEST(EngineLevels, partner_with_less_support_than_promised_is_refused) {
  const BakedBody small = pruned(10);
  ASSERT_GT(small.view.header->dropped_levels, 0u);
  const ImageView images[2] = {small.view, bodies().b.view};
  const BodyPair pairs[1] = {{0, 1}};
  const Scene scene{images, pairs, 0};
  const AlignedMemory memory(required_bytes(scene, {}));
  Engine* engine = nullptr;
  EXPECT_EQ(create(scene, with_s0(1e3), {}, memory.span(), engine), Status::image_too_coarse);
}

TEST(EngineLevels, image_for_a_threshold_leaves_out_all_it_can) {
  const auto served = static_cast<double>(pruned().view.header->s0_min);
  bake::BakeOptions options = coarse();
  options.s0_min = served;
  const BakedBody same(bumpy_ball(24, 32, 1), options);
  EXPECT_EQ(same.view.header->dropped_levels, pruned().view.header->dropped_levels);
  options.s0_min = 0.999 * served;
  const BakedBody finer(bumpy_ball(24, 32, 1), options);
  EXPECT_LT(finer.view.header->dropped_levels, same.view.header->dropped_levels);
  EXPECT_LE(static_cast<double>(finer.view.header->s0_min), options.s0_min);
}

TEST(EngineLevels, image_of_a_given_size_is_the_finest_that_fits) {
  const std::uint64_t whole = bodies().a.view.header->total_bytes;
  bake::BakeOptions options = coarse();
  options.max_bytes = static_cast<std::size_t>(whole / 2);
  const BakedBody half(bumpy_ball(24, 32, 1), options);
  EXPECT_LE(half.view.header->total_bytes, options.max_bytes);
  EXPECT_GT(half.view.header->s0_min, 0);
  options.max_bytes = 1000;
  bake::BakeReport report;
  const bake::Mesh mesh = bumpy_ball(24, 32, 1);
  EXPECT_THROW(bake::bake(mesh, bake::check(mesh), options, {}, report), bake::InputRefused);
}

}  // namespace
}  // namespace palpate::test
