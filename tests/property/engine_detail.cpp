// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies from which detail was left out before baking: what both engines certify holds of the
// meshes that were read.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/answers.hpp"
#include "tests/support/coarse_bodies.hpp"
#include "tests/support/placements.hpp"

namespace palpate::test {
namespace {

constexpr double kDeviation = 0.02;
constexpr double kWide = 0.5;  // contact tolerance, wide enough for both to be left out of

bake::BakeOptions without_detail(double max_deviation_rel) {
  bake::BakeOptions options = coarse();
  options.engine = bake::ForEngine::both;
  options.max_deviation_rel = max_deviation_rel;
  return options;
}

struct ReducedBodies {
  BakedBody a{bumpy_ball(24, 32, 1), without_detail(kDeviation)};
  BakedBody b{bumpy_ball(20, 28, 0.8), without_detail(kDeviation)};
};

const ReducedBodies& reduced() {
  static const ReducedBodies both;
  return both;
}

/// Of the two together, in metres.
double left_out_m() {
  double sum = 0;
  for (const BakedBody* body : {&reduced().a, &reduced().b}) {
    const image::Header& h = *body->view.header;
    sum += static_cast<double>(h.source_deviation_rel) * h.radius_m;
  }
  return sum;
}

Settings regions_settings() {
  return {
      .engine = EngineKind::regions, .delta_m = kWide, .exact = true, .stiffness_N_per_m = 1000};
}

struct Placement {
  Pose poses[2];
  double truth = 0;  ///< distance of the meshes read
};

std::vector<Placement> placements() {
  std::vector<Placement> out;
  for_each_placement(reduced().a, reduced().b, kWide, 8, [&](const Pose(&poses)[2]) {
    out.push_back({{poses[0], poses[1]},
                   distance_of(PlacedTriangles(reduced().a.mesh, poses[0]),
                               PlacedTriangles(reduced().b.mesh, poses[1]))});
  });
  return out;
}

TEST(EngineDetail, bodies_have_less_of_it) {
  for (const BakedBody* body : {&reduced().a, &reduced().b}) {
    EXPECT_LT(body->view.header->source_triangles, 0.8 * double(body->mesh.faces.size()));
    EXPECT_GT(body->view.header->source_deviation_rel, 0);
    EXPECT_LE(body->view.header->source_deviation_rel, kDeviation);
  }
}

TEST(EngineDetail, certificates_hold_of_the_meshes_read) {
  const std::vector<Placement> all = placements();
  double worst = 0;
  for (const EngineKind engine : {EngineKind::levels, EngineKind::regions}) {
    for (const std::uint64_t units : {100u, 2000u, 1000000u}) {
      BakedScene scene({reduced().a.view, reduced().b.view}, {{0, 1}},
                       {.engine = engine, .delta_m = kWide});
      for (const Placement& at : all) {
        const TickResult r = tick_or_fail(*scene.engine, at.poses, {.units = units});
        EXPECT_GE(r.certificate.error_bound_m, left_out_m());
        expect_certified(r, at.truth, kWide);
        if (units == 1000000u) worst = std::fmax(worst, std::abs(r.min_distance_m - at.truth));
      }
    }
  }
  EXPECT_GT(worst, 1e-4) << "nothing was left out where they touch";
}

TEST(EngineDetail, bound_of_the_force_counts_what_was_left_out) {
  BakedScene scene({reduced().a.view, reduced().b.view}, {{0, 1}}, regions_settings());
  for (const Placement& at : placements()) {
    const TickResult r = tick_or_fail(*scene.engine, at.poses);
    EXPECT_GE(r.certificate.force_bound_N,
              2 * 0.999 * regions_settings().stiffness_N_per_m * left_out_m());
  }
  const Pose far[2] = {{{6, 0, 0}, {}}, {}};
  EXPECT_EQ(tick_or_fail(*scene.engine, far).certificate.force_bound_N, 0);
}

// Nearer than delta by less than what was left out: no contact, and the certificate says so.
TEST(EngineDetail, contacts_that_detail_would_give_are_in_the_bound) {
  const double gap = kWide - 0.1 * left_out_m();
  std::mt19937 rng(3);
  int beyond = 0;
  for (int i = 0; i < 24; ++i) {
    BakedScene scene({reduced().a.view, reduced().b.view}, {{0, 1}}, regions_settings());
    const Pose poses[2] = {approach(reduced().a.mesh, reduced().b.mesh, gap, 4, random_unit(rng),
                                    turn(3.0 * random_unit(rng))),
                           {}};
    const TickResult r = tick_or_fail(*scene.engine, poses);
    if (!r.contacts.empty()) continue;
    ++beyond;
    EXPECT_GE(r.certificate.force_bound_N,
              regions_settings().stiffness_N_per_m * 0.09 * left_out_m());
  }
  EXPECT_GE(beyond, 2);
}

TEST(EngineDetail, tolerance_no_larger_than_what_was_left_out_is_refused) {
  for (const EngineKind kind : {EngineKind::levels, EngineKind::regions}) {
    Settings s{.engine = kind, .delta_m = 1.01 * left_out_m()};
    BakedScene scene({reduced().a.view, reduced().b.view}, {{0, 1}}, s);
    s.delta_m = 0.99 * left_out_m();
    EXPECT_EQ(configure(*scene.engine, s), Status::image_too_coarse);
    Engine* refused = nullptr;
    EXPECT_EQ(create(scene.scene(), s, {}, scene.memory.span(), refused), Status::image_too_coarse);
    EXPECT_EQ(refused, nullptr);
  }
}

TEST(EngineDetail, bodies_with_all_of_it_certify_as_before) {
  const BakedBody whole(bumpy_ball(24, 32, 1), without_detail(0));
  EXPECT_EQ(whole.view.header->source_deviation_rel, 0);
  BakedScene scene({whole.view, whole.view}, {{0, 1}}, regions_settings());
  const Pose poses[2] = {{{2.02, 0, 0}, {}}, {}};
  EXPECT_LT(tick_or_fail(*scene.engine, poses).certificate.error_bound_m, 1e-5);
}

}  // namespace
}  // namespace palpate::test
