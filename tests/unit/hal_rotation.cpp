// SPDX-License-Identifier: Apache-2.0
#include "hal/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace palpate::hal {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Rotation, quarter_turn_about_z_is_the_known_quaternion) {
  const Quat q = rotation_from_vector({0, 0, std::numbers::pi / 2});
  EXPECT_NEAR(q.w, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(q.z, std::sqrt(0.5), 1e-15);
}

TEST(Rotation, vector_survives_the_way_there_and_back) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> component(-1, 1);
  for (const double length : {0.0, 1e-300, 1e-13, 1e-9, 1e-5, 0.1, 1.0, 3.1}) {
    for (int i = 0; i < 20; ++i) {
      const Vec3d d{component(random), component(random), component(random)};
      const Vec3d v = (length / norm(d)) * d;
      expect_near(vector_from_rotation(rotation_from_vector(v)), v, 1e-14 * (1 + length));
    }
  }
}

TEST(Rotation, opposite_quaternions_give_the_same_short_vector) {
  const Quat q = rotation_from_vector({0.3, -0.2, 0.5});
  const Quat opposite{-q.w, -q.x, -q.y, -q.z};
  expect_near(vector_from_rotation(opposite), {0.3, -0.2, 0.5}, 1e-14);
}

TEST(Rotation, between_two_orientations_leads_from_one_to_the_other_in_world_axes) {
  const Quat from = rotation_from_vector({1.0, 0.4, -0.7});
  const Vec3d turn{0.2, -0.3, 0.1};
  expect_near(rotation_between(from, rotation_from_vector(turn) * from), turn, 1e-14);
}

TEST(Rotation, zero_quaternion_normalises_to_identity) {
  EXPECT_EQ(normalised({0, 0, 0, 0}).w, 1.0);
  EXPECT_NEAR(normalised({2, 0, 0, 2}).z, std::sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace palpate::hal
