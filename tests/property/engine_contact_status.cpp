// SPDX-License-Identifier: GPL-3.0-or-later
// What a tick says of whether there is a contact: never too much, and no less than it has found.
#include <gtest/gtest.h>

#include "tests/support/brute_force.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/placements.hpp"
#include "tests/support/two_balls.hpp"

namespace palpate::test {
namespace {

constexpr double kDelta_m = 0.05;

/// At this distance, along some direction.
Pose placed(double distance_m, int which) {
  std::mt19937 rng(static_cast<unsigned>(which));
  const Vec3d from = random_unit(rng);
  return approach(two_balls().a.mesh, two_balls().b.mesh, distance_m, 4, from,
                  turn(random_unit(rng)));
}

class ContactStatusOf : public testing::TestWithParam<EngineKind> {
 protected:
  ContactStatus status(double distance_m, int which, std::uint64_t units) const {
    const Settings settings{.engine = GetParam(), .delta_m = kDelta_m, .exact = true};
    BakedScene scene({two_balls().a.view, two_balls().b.view}, {{0, 1}}, settings,
                     {.nodes = 1u << 14});
    const Pose poses[2] = {placed(distance_m, which), {}};
    return tick_or_fail(*scene.engine, poses, {.units = units}).certificate.contact;
  }
};

constexpr std::uint64_t kEnough = 1u << 20;
constexpr int kPlaces = effort(8, 2);

TEST_P(ContactStatusOf, rules_out_what_is_not_there_where_the_budget_does) {
  for (int i = 0; i < kPlaces; ++i) {
    for (const double apart : {1.001, 1.2, 3.0, 30.0}) {
      EXPECT_EQ(status(apart * kDelta_m, i, kEnough), ContactStatus::ruled_out) << apart;
      EXPECT_EQ(status(apart * kDelta_m, i, Budget{}.units), ContactStatus::ruled_out) << apart;
    }
  }
}

TEST_P(ContactStatusOf, rules_out_nothing_that_is_there) {
  for (int i = 0; i < kPlaces; ++i) {
    for (const double near : {0.999, 0.5, 0.01}) {
      EXPECT_EQ(status(near * kDelta_m, i, kEnough), ContactStatus::found) << near;
      for (const std::uint64_t units : {0u, 1u, 5u, 20u, 80u, 300u}) {
        EXPECT_NE(status(near * kDelta_m, i, units), ContactStatus::ruled_out) << near << units;
      }
    }
  }
}

TEST_P(ContactStatusOf, is_undecided_where_nothing_was_looked_at) {
  EXPECT_EQ(status(1.001 * kDelta_m, 0, 0), ContactStatus::undecided);
  EXPECT_EQ(status(0.5 * kDelta_m, 0, 0), ContactStatus::undecided);
}

INSTANTIATE_TEST_SUITE_P(Engines, ContactStatusOf,
                         testing::Values(EngineKind::levels, EngineKind::regions),
                         [](const auto& tested) {
                           return tested.param == EngineKind::levels ? "levels" : "regions";
                         });

}  // namespace
}  // namespace palpate::test
