// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/friction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace palpate::force {
namespace {

constexpr BodyPair kPairs[] = {{0, 1}, {2, 0}};
constexpr double kStiffness_N_per_m = 500;
constexpr double kMu = 0.4;
const Settings kSettings{.delta_m = 0.001, .stiffness_N_per_m = kStiffness_N_per_m};

/// A contact that pushes the tool along a normal with a force.
Contact pressed(Vec3d point_m, Vec3d normal, double force_N, std::uint32_t pair = 0) {
  Contact c;
  c.point_a_m = c.point_b_m = c.centre_m = point_m;
  c.normal = normal;
  c.weight = 1;
  c.distance_m = kSettings.delta_m - force_N / kStiffness_N_per_m;
  c.pair = pair;
  return c;
}

struct Rig {
  explicit Rig(double mu = kMu) : coefficients{mu, mu} {}

  TickResult feel(const std::vector<Contact>& contacts) {
    TickResult out;
    out.contacts = contacts;
    friction.add(kPairs, 0, kSettings, poses, out);
    return out;
  }

  std::vector<double> coefficients;
  std::vector<Stick> sticks{2};
  Friction friction{coefficients, sticks};
  std::vector<Pose> poses{3};
};

TEST(Friction, sticks_like_a_spring_and_slips_at_the_coefficient_times_the_normal_force) {
  Rig rig;
  constexpr double kNormal_N = 2, kStep_m = 1e-5;
  for (int i = 0; i < 400; ++i) {
    rig.poses[0].position_m.x = kStep_m * i;
    const TickResult r = rig.feel({pressed({kStep_m * i, 0, 0}, {0, 0, 1}, kNormal_N)});
    const double expected_N = std::min(kStiffness_N_per_m * kStep_m * i, kMu * kNormal_N);
    ASSERT_NEAR(r.wrench.force_N.x, -expected_N, 1e-10) << i;
    ASSERT_NEAR(r.wrench.force_N.z, 0, 1e-12);
  }
}

TEST(Friction, turned_round_gives_the_loop_of_dahl) {
  Rig rig;
  constexpr double kStep_m = 1e-5, kMost_N = kMu * 1.0;
  const auto at = [&](double x_m) {
    rig.poses[0].position_m.x = x_m;
    return rig.feel({pressed({x_m, 0, 0}, {0, 0, 1}, 1)}).wrench.force_N.x;
  };
  for (int i = 0; i <= 300; ++i) at(kStep_m * i);
  for (int i = 1; i <= 300; ++i) {
    const double expected_N = std::max(kMost_N - kStiffness_N_per_m * kStep_m * i, -kMost_N);
    ASSERT_NEAR(at(kStep_m * (300 - i)), -expected_N, 1e-10) << i;
  }
}

TEST(Friction, follows_a_falling_normal_force_and_forgets_on_lifting_off) {
  Rig rig;
  rig.feel({pressed({}, {0, 0, 1}, 2)});
  rig.poses[0].position_m.x = 0.01;
  EXPECT_NEAR(rig.feel({pressed({}, {0, 0, 1}, 2)}).wrench.force_N.x, -kMu * 2, 1e-12);
  EXPECT_NEAR(rig.feel({pressed({}, {0, 0, 1}, 0.5)}).wrench.force_N.x, -kMu * 0.5, 1e-12);
  EXPECT_NEAR(rig.feel({pressed({}, {0, 0, 1}, 2)}).wrench.force_N.x, -kMu * 0.5, 1e-12);
  rig.feel({});
  EXPECT_EQ(norm(rig.feel({pressed({}, {0, 0, 1}, 2)}).wrench.force_N), 0);
}

TEST(Friction, clenched_peg_is_held_by_both_sides) {
  Rig rig;
  const std::vector<Contact> clench{pressed({0, 0, 0.01}, {0, 0, -1}, 1.5),
                                    pressed({0, 0, -0.01}, {0, 0, 1}, 1.5)};
  rig.feel(clench);
  rig.poses[0].position_m = {0.1, 0, 0.0001};
  const TickResult r = rig.feel(clench);
  EXPECT_NEAR(r.wrench.force_N.x, -kMu * 3, 1e-12);
  EXPECT_NEAR(r.wrench.force_N.z, 0, 1e-12);  // along the normals the contacts push, not friction
}

TEST(Friction, turns_about_the_centre_of_pressure) {
  Rig rig;
  const std::vector<Contact> two{pressed({0, 0.02, -0.03}, {0, 0, 1}, 1),
                                 pressed({0, 0.04, -0.03}, {0, 0, 1}, 1)};
  rig.feel(two);
  rig.poses[0].position_m.x = 1e-5;
  const TickResult r = rig.feel(two);
  const Vec3d expected = cross(Vec3d{-1e-5, 0.03, -0.03}, r.wrench.force_N);
  EXPECT_NEAR(r.wrench.force_N.x, -kStiffness_N_per_m * 1e-5, 1e-12);
  EXPECT_NEAR(norm(r.wrench.torque_Nm - expected), 0, 1e-12);
}

TEST(Friction, does_not_care_which_body_moves) {
  Rig tool, other;
  const std::vector<Contact> c{pressed({0.01, 0, 0}, {0, 0, 1}, 1)};
  tool.feel(c);
  other.feel(c);
  tool.poses[0].position_m.y = 2e-5;
  other.poses[1].position_m.y = -2e-5;
  EXPECT_NEAR(norm(tool.feel(c).wrench.force_N - other.feel(c).wrench.force_N), 0, 1e-12);
}

TEST(Friction, turns_with_the_body_it_sticks_to) {
  Rig rig;
  rig.feel({pressed({}, {0, 0, 1}, 1)});
  rig.poses[0].position_m.x = 1e-4;
  rig.feel({pressed({1e-4, 0, 0}, {0, 0, 1}, 1)});
  const double s = std::sqrt(0.5);  // both bodies turn by a right angle about z
  for (Pose& p : rig.poses) p.orientation = {s, 0, 0, s};
  rig.poses[0].position_m = {0, 1e-4, 0};
  const TickResult r = rig.feel({pressed({0, 1e-4, 0}, {0, 0, 1}, 1)});
  EXPECT_NEAR(norm(r.wrench.force_N - Vec3d{0, -kStiffness_N_per_m * 1e-4, 0}), 0, 1e-10);
}

TEST(Friction, of_no_coefficient_leaves_the_wrench_alone) {
  Rig rig(0);
  rig.feel({pressed({}, {0, 0, 1}, 1)});
  rig.poses[0].position_m.x = 1;
  EXPECT_EQ(norm(rig.feel({pressed({}, {0, 0, 1}, 1)}).wrench.force_N), 0);
}

TEST(Friction, stiffness_tells_how_a_sticking_force_falls) {
  Rig rig;
  const std::vector<Contact> c{pressed({0.01, -0.02, 0.03}, {0.6, 0, 0.8}, 5)};
  rig.feel(c);
  const TickResult before = rig.feel(c);
  const Vec3d shift_m{1e-6, -2e-6, 3e-6};
  rig.poses[0].position_m = shift_m;
  const TickResult after = rig.feel(c);
  const Vec6 fall = before.stiffness * vec6(shift_m, {});
  EXPECT_NEAR(norm(before.wrench.force_N - linear(fall) - after.wrench.force_N), 0, 1e-12);
  rig.poses[0].position_m = {1, 0, 0};
  const Vec6 slipping = rig.feel(c).stiffness * vec6({1, 1, 1}, {1, 1, 1});
  for (const double v : slipping) EXPECT_EQ(v, 0);
}

/// Whatever the motion, the normals and the normal forces: the hand never gets more out of it than
/// it has put in, with the force that each move ends with.
TEST(Friction, gives_back_no_more_than_it_was_given) {
  std::mt19937 rng(5);
  std::normal_distribution<double> g;
  std::uniform_real_distribution<double> u(0, 3);
  for (int round = 0; round < 20; ++round) {
    Rig rig;
    double work_J = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d step_m = 2e-4 * Vec3d{g(rng), g(rng), g(rng)};
      rig.poses[0].position_m += step_m;
      std::vector<Contact> c;
      for (int k = 0; k < 3; ++k) {
        const Vec3d n{g(rng), g(rng), g(rng)};
        if (u(rng) > 0.2) c.push_back(pressed({}, (1 / norm(n)) * n, u(rng)));
      }
      work_J -= dot(rig.feel(c).wrench.force_N, step_m);
      ASSERT_GE(work_J, -1e-12);
    }
    EXPECT_GT(work_J, 0.05);
  }
}

}  // namespace
}  // namespace palpate::force
