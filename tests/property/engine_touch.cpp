// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that begin to overlap: the force goes on as it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/support/baked_scene.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

constexpr double kDelta = 0.05;
constexpr double kGap = 1e-4 * kDelta;
constexpr int kBodies = 40, kTouches = 30;

/// A ball whose corners lie at random depths: sharp edges between patches of every angle.
bake::Mesh crumpled(std::mt19937& rng, std::uint32_t rings, std::uint32_t sectors) {
  std::uniform_real_distribution<double> radius(0.6, 1);
  bake::Mesh m = ball(rings, sectors, 1);
  for (bake::Point& p : m.points) {
    const double r = radius(rng);
    p = {r * p[0], r * p[1], r * p[2]};
  }
  return m;
}

struct Engine {
  EngineKind kind;
  bake::ForEngine baked;
  const char* name;
  double most_kicks;   ///< share of the touches
  double most_turned;  ///< share of the contacts
};
std::string name_of(const testing::TestParamInfo<Engine>& info) { return info.param.name; }

class Touch : public testing::TestWithParam<Engine> {};

TEST_P(Touch, seldom_kicks_where_sharp_bodies_begin_to_overlap) {
  const Settings settings{.engine = GetParam().kind,
                          .delta_m = kDelta,
                          .exact = true,
                          .stiffness_N_per_m = 1 / kDelta,
                          .cluster_radius_m = kDelta};
  std::mt19937 rng(5);
  int kicks = 0, turned = 0, contacts = 0;
  for (int body = 0; body < kBodies; ++body) {
    const bool fine = body % 2 != 0;
    const BakedBody a(crumpled(rng, fine ? 6 : 3, fine ? 9 : 4), GetParam().baked);
    const BakedBody b(crumpled(rng, fine ? 6 : 3, fine ? 9 : 4), GetParam().baked);
    BakedScene scene({a.view, b.view}, {{0, 1}}, settings);
    for (int i = 0; i < kTouches; ++i) {
      const Vec3d out = random_unit(rng);
      Pose pose = approach(a.mesh, b.mesh, kGap, 4, out, turn(3.0 * random_unit(rng)));
      const Pose before[2] = {pose, {}};
      const TickResult apart = tick_or_fail(*scene.engine, before);
      ASSERT_FALSE(apart.contacts.empty());
      EXPECT_NEAR(apart.min_distance_m, kGap, 0.1 * kGap);
      const std::vector<Contact> known(apart.contacts.begin(), apart.contacts.end());
      const Vec3d force_N = apart.wrench.force_N;
      const auto nearest = std::min_element(
          known.begin(), known.end(),
          [](const Contact& x, const Contact& y) { return x.distance_m < y.distance_m; });
      pose.position_m -= (2 * kGap / std::max(0.05, std::abs(dot(out, nearest->normal)))) * out;
      const Pose after[2] = {pose, {}};
      const TickResult in = tick_or_fail(*scene.engine, after);
      kicks += norm(in.wrench.force_N - force_N) > 0.02 ? 1 : 0;
      for (const Contact& x : known) {
        for (const Contact& y : in.contacts) {
          if (x.piece_a != y.piece_a || x.piece_b != y.piece_b || y.distance_m > 0) continue;
          if (x.distance_m > 2 * kGap) continue;
          ++contacts;
          turned += dot(x.normal, y.normal) < 0.99 ? 1 : 0;
        }
      }
    }
  }
  RecordProperty("kicks", kicks);
  RecordProperty("turned", turned);
  RecordProperty("contacts", contacts);
  EXPECT_LT(kicks, GetParam().most_kicks * kBodies * kTouches);
  EXPECT_LT(turned, GetParam().most_turned * contacts);
}

INSTANTIATE_TEST_SUITE_P(
    Engines, Touch,
    // Contacts of the regions engine are vertices' and edges', and one piece has several of them.
    // Of sharp edges the least push turns within the depth (docs/CONTACT.md, Sec. 8.1).
    testing::Values(Engine{EngineKind::levels, bake::ForEngine::levels, "levels", 0.03, 0.02},
                    Engine{EngineKind::regions, bake::ForEngine::regions, "regions", 0.2, 1}),
    name_of);

}  // namespace
}  // namespace palpate::test
