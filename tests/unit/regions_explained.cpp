// SPDX-License-Identifier: Apache-2.0
// What a push explains cannot change it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "rt_core/regions/explained.hpp"

namespace palpate::test {
namespace {

class Directions {
 public:
  explicit Directions(unsigned seed) : rng_(seed) {}
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng_);
  }
  Vec3d any() {
    std::normal_distribution<double> normal;
    const Vec3d v{normal(rng_), normal(rng_), normal(rng_)};
    return (1 / norm(v)) * v;
  }
  /// At an angle from an axis.
  Vec3d beside(Vec3d axis, double angle) {
    const Vec3d u = across(axis);
    const Vec3d v = cross(axis, u);
    const double turn = number(0, 6.28318);
    return std::cos(angle) * axis + std::sin(angle) * (std::cos(turn) * u + std::sin(turn) * v);
  }

 private:
  std::mt19937 rng_;
};

force::Push push_of(Directions& from, int contacts, double& strongest) {
  std::vector<force::PushConstraint> constraints;
  for (int i = 0; i < contacts; ++i) {
    constraints.push_back({from.any(), from.number(0.1, 1)});
    strongest = std::max(strongest, constraints.back().strength);
  }
  return force::least_push(constraints).push;
}

TEST(Explained, No_contact_of_that_strength_exceeds_the_push) {
  Directions from(7);
  for (int round = 0; round < 2000; ++round) {
    double strongest = 0;
    const force::Push push = push_of(from, 1 + round % 5, strongest);
    const double cone = from.number(0, 1.2);
    const Vec3d axis = from.any();
    const double most = regions::explained({push, 1, strongest}, axis, std::cos(cone));
    for (int i = 0; i < 20; ++i) {
      const double tilt = from.number(0, contact::kMostTilt_rad);
      const Vec3d n = from.beside(axis, from.number(0, cone) + tilt);
      // At least as much is left of it as its tilt from the nearest normal of the cone leaves.
      const double outside = std::acos(std::min(1.0, dot(n, axis))) - cone;
      const double weight = contact::facing(std::cos(std::max(0.0, outside)));
      const double strength = weight * most - (1 - weight) * force::kFadedShare * strongest;
      ASSERT_LE(strength, push.along(n) + 1e-9) << round << " " << i;
    }
  }
}

TEST(Explained, One_contact_explains_others_of_its_direction_as_far_as_it_pushes) {
  const force::PushConstraint one[] = {{{0, 0, 1}, 1}};
  const force::Push push = force::least_push(one).push;
  EXPECT_NEAR(regions::explained({push, 1, 1}, {0, 0, 1}, 1), 1, 1e-3);
  EXPECT_LE(regions::explained({push, 1, 1}, {0, 0, 1}, 1), 1);
  EXPECT_LE(regions::explained({push, 1, 1}, {1, 0, 0}, 1), 0);
  EXPECT_LE(regions::explained({push, 1, 1}, {0, 0, -1}, 1), 0);
}

}  // namespace
}  // namespace palpate::test
