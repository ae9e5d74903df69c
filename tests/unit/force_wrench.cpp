// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/wrench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "rt_core/force/constraints.hpp"

namespace palpate::force {
namespace {

constexpr BodyPair kPairs[] = {{0, 1}, {2, 0}, {1, 2}};

Contact at(Vec3d point, Vec3d normal, double distance, std::uint32_t pair = 0) {
  Contact c;
  c.centre_m = point;
  c.normal = normal;
  c.distance_m = distance;
  c.pair = pair;
  return c;
}

const Settings kSettings{.delta_m = 0.001, .stiffness_N_per_m = 500, .cluster_radius_m = 0.01};

PushWrench feel(const std::vector<Contact>& contacts, const Settings& settings = kSettings,
                const Pose& pose = {}, std::size_t places = 4096) {
  std::vector<PushConstraint> constraints(contacts.size());
  std::vector<PushPoint> points(contacts.size());
  std::vector<Place> table(places);
  Places grid{table};
  set_constraints(contacts, kPairs, 0, settings.delta_m, constraints);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    points[i].arm_m = contacts[i].centre_m - pose.position_m;
  }
  return push_wrench(constraints, least_push(constraints), points, pose, settings, grid);
}

struct Random {
  std::mt19937 rng;
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng);
  }
  Vec3d vector(double size) {
    return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)};
  }
  Vec3d direction() {
    while (true) {
      const Vec3d v = vector(1);
      const double length = norm(v);
      if (length > 0.1 && length < 1) return (1 / length) * v;
    }
  }
  std::vector<Contact> contacts(int count, double spread_m) {
    std::vector<Contact> c;
    for (int i = 0; i < count; ++i) {
      // In this order with every compiler.
      const double distance_m = (*this)(-0.0005, 0.001);
      const Vec3d normal = direction();
      c.push_back(at(vector(spread_m), normal, distance_m));
    }
    return c;
  }
};

TEST(Wrench, no_contact_gives_no_force) { EXPECT_EQ(feel({}).wrench.force_N, (Vec3d{})); }

TEST(Wrench, one_contact_is_a_spring) {
  const PushWrench p = feel({at({0.1, 0.003, 0}, {0, 0, 1}, 0.0004)});
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0006, 1e-9);
  EXPECT_NEAR(p.wrench.torque_Nm.x, 0.003 * 0.3, 1e-9);
  EXPECT_NEAR(p.wrench.torque_Nm.y, -0.1 * 0.3, 1e-9);
}

/// Contacts all around, of which many share a normal: the force is that of the push, 2 k v.
TEST(Wrench, force_is_that_of_the_least_push) {
  Random random{std::mt19937(7)};
  for (int round = 0; round < 40; ++round) {
    const std::vector<Contact> c = random.contacts(1 + round, 0.02);
    std::vector<PushConstraint> constraints(c.size());
    set_constraints(c, kPairs, 0, kSettings.delta_m, constraints);
    const Vec3d expected = 1000.0 * least_push(constraints).push.vector;
    EXPECT_NEAR(norm(feel(c).wrench.force_N - expected), 0, 1e-9);
  }
}

TEST(Wrench, stiffness_tells_how_the_wrench_of_one_contact_falls) {
  const Vec3d point{0.02, -0.01, 0.005}, normal{0.6, 0, 0.8};
  const auto wrench_at = [&](Vec3d shift) {  // of the tool, whose point moves with it
    return feel({at(point, normal, 0.0004 + dot(shift, normal))}).wrench;
  };
  const PushWrench p = feel({at(point, normal, 0.0004)});
  const Vec3d shift{1e-7, -2e-7, 3e-7};
  const Vec6 fall = p.stiffness * vec6(shift, {});
  const Wrench moved = wrench_at(shift);
  EXPECT_NEAR(norm(moved.force_N - (p.wrench.force_N - linear(fall))), 0, 1e-9);
  EXPECT_NEAR(norm(moved.torque_Nm - (p.wrench.torque_Nm - angular(fall))), 0, 1e-9);
  const Vec6 turned = p.stiffness * vec6({}, {0, 1e-6, 0});
  EXPECT_NEAR(norm(linear(turned) - 500 * dot(cross(Vec3d{0, 1e-6, 0}, point), normal) * normal), 0,
              1e-9);
}

TEST(Wrench, order_of_contacts_does_not_matter) {
  Random random{std::mt19937(3)};
  std::vector<Contact> c = random.contacts(200, 0.05);
  for (std::size_t i = 0; i < 50; ++i) c[i].distance_m = 0.0003;  // ties
  const PushWrench first = feel(c);
  for (int k = 0; k < 20; ++k) {
    std::shuffle(c.begin(), c.end(), random.rng);
    const PushWrench again = feel(c);
    EXPECT_NEAR(norm(again.wrench.force_N - first.wrench.force_N), 0, 1e-9);
    EXPECT_NEAR(norm(again.wrench.torque_Nm - first.wrench.torque_Nm), 0, 1e-9);
  }
}

TEST(Wrench, wide_contact_of_one_normal_gives_its_largest_depth_however_it_is_cut) {
  for (const int cuts : {1, 2, 5, 40}) {
    std::vector<Contact> c;
    for (int i = 0; i < cuts * cuts; ++i) {
      const double x = (i % cuts + 0.5) / cuts - 0.5, y = (i / cuts + 0.5) / cuts - 0.5;
      c.push_back(at({0.1 * x, 0.1 * y, 0}, {0, 0, 1}, 0.0002 + 0.001 * (x * x + y * y)));
    }
    c.push_back(at({}, {0, 0, 1}, 0.0002));
    const PushWrench p = feel(c);
    EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0008, 1e-9) << cuts;
    EXPECT_NEAR(norm(p.wrench.torque_Nm), 0, 2e-3 * 0.4) << cuts;
  }
}

/// By twice as much: what carries less than half of the push takes no part in the torque.
TEST(Wrench, peg_on_both_ends_turns_back_like_two_springs_of_twice_the_stiffness) {
  constexpr double kHalf_m = 0.05, kAngle_rad = 1e-6, kDepth_m = 0.0005;
  const PushWrench p = feel({at({kHalf_m, 0, 0}, {0, 0, 1}, 0.0005 - kAngle_rad * kHalf_m),
                             at({-kHalf_m, 0, 0}, {0, 0, 1}, 0.0005 + kAngle_rad * kHalf_m)});
  EXPECT_NEAR(p.wrench.force_N.z, 500 * kDepth_m, 2e-4 * 500 * kDepth_m);
  const double two_springs_Nm = 2 * 1000 * kHalf_m * kHalf_m * kAngle_rad;
  EXPECT_NEAR(-p.wrench.torque_Nm.y, two_springs_Nm, 1e-3 * two_springs_Nm);
}

TEST(Wrench, triangles_at_one_end_of_a_peg_do_not_pull_the_force_there) {
  std::vector<Contact> c{at({-0.05, 0, 0}, {0, 0, 1}, 0.0004)};
  for (int i = 0; i < 500; ++i) c.push_back(at({0.05, 1e-7 * i, 0}, {0, 0, 1}, 0.0004));
  EXPECT_NEAR(feel(c).wrench.torque_Nm.y, 0, 0.3 * 0.05 * 0.01);
}

TEST(Wrench, contact_at_delta_brings_nothing) {
  Random random{std::mt19937(5)};
  const std::vector<Contact> c = random.contacts(20, 0.02);
  const Wrench without = feel(c).wrench;
  for (const double distance : {0.001, 0.001 - 1e-12}) {
    std::vector<Contact> with = c;
    with.push_back(at(random.vector(0.02), random.direction(), distance));
    EXPECT_NEAR(norm(feel(with).wrench.force_N - without.force_N), 0, 1e-8);
  }
}

TEST(Wrench, opposed_normals_keep_their_forces) {
  const Contact up = at({}, {0, 0, 1}, 0.0004);
  EXPECT_NEAR(norm(feel({up, at({}, {0, 0, -1}, 0.0004)}).wrench.force_N), 0, 1e-9);
  const PushWrench p = feel({up, at({}, {0, 0, -1}, 0.0001)});
  EXPECT_NEAR(p.wrench.force_N.z, 500 * (0.0006 - 0.0009), 1e-9);
}

TEST(Wrench, perpendicular_walls_do_not_feel_each_other) {
  const PushWrench p = feel({at({0, 0, 0}, {1, 0, 0}, 0.0004), at({0, 0, 0}, {0, 1, 0}, 0.0001),
                             at({0, 0, 0}, {0, 0, 1}, -0.0002)});
  EXPECT_NEAR(p.wrench.force_N.x, 500 * 0.0006, 1e-9);
  EXPECT_NEAR(p.wrench.force_N.y, 500 * 0.0009, 1e-9);
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0012, 1e-9);
}

TEST(Wrench, moves_with_the_scene) {
  Random random{std::mt19937(11)};
  std::vector<Contact> c = random.contacts(40, 0.02);
  const PushWrench p = feel(c);
  Pose pose;
  pose.position_m = {1, -2, 0.5};
  pose.orientation = {0.5, 0.5, -0.5, 0.5};
  const Mat3d turn = rotation(pose.orientation);
  std::vector<Contact> moved = c;
  for (Contact& m : moved) {
    m.centre_m = turn * m.centre_m + pose.position_m;
    m.normal = turn * m.normal;
  }
  const PushWrench q = feel(moved, kSettings, pose);
  EXPECT_NEAR(norm(q.wrench.force_N - turn * p.wrench.force_N), 0, 1e-9);
  EXPECT_NEAR(norm(q.wrench.torque_Nm - turn * p.wrench.torque_Nm), 0, 1e-11);
}

TEST(Wrench, pushes_the_tool_whichever_side_of_a_pair_it_is) {
  const PushWrench p =
      feel({at({0, 0, 0}, {0, 0, 1}, 0.0004, 0), at({0, 0, 0}, {0, 0, -1}, 0.0004, 1)});
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0006, 1e-9);  // two bodies, one direction: felt once
}

TEST(Wrench, pairs_without_the_tool_add_no_force) {
  EXPECT_EQ(feel({at({}, {0, 0, 1}, 0.0004, 2)}).wrench.force_N, (Vec3d{}));
}

TEST(Wrench, full_table_of_places_keeps_the_force) {
  std::vector<Contact> c;
  for (int i = 0; i < 100; ++i) c.push_back(at({0.1 * i, 0, 0}, {0, 0, 1}, 0.0005));
  const PushWrench p = feel(c, kSettings, {}, 3);
  EXPECT_TRUE(p.places_full);
  EXPECT_FALSE(feel(c).places_full);
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0005, 1e-9);
}

TEST(Wrench, scales_from_micrometres_to_kilometres) {
  for (const double scale : {1e-9, 1e-3, 1.0, 1e6}) {
    Settings s = kSettings;
    s.delta_m *= scale;
    s.cluster_radius_m *= scale;
    s.stiffness_N_per_m /= scale;
    Random random{std::mt19937(12)};
    std::vector<Contact> c = random.contacts(30, 0.02);
    const PushWrench p = feel(c);
    for (Contact& contact : c) {
      contact.centre_m = scale * contact.centre_m;
      contact.distance_m *= scale;
    }
    EXPECT_NEAR(norm(feel(c, s).wrench.force_N - p.wrench.force_N), 0, 1e-6);
  }
}

TEST(Limits, scale_the_length_and_keep_the_direction) {
  Settings s = kSettings;
  s.max_force_N = 0.1;
  s.max_torque_Nm = 0.001;
  const Wrench free{{1, 2, 3}, {-1, 0, 2}};
  const Wrench held = limited(free, s);
  EXPECT_NEAR(norm(held.force_N), 0.1, 1e-15);
  EXPECT_NEAR(norm(held.torque_Nm), 0.001, 1e-15);
  EXPECT_NEAR(norm(cross(free.torque_Nm, held.torque_Nm)), 0, 1e-15);
}

TEST(Kinship, is_one_for_equal_and_nothing_for_perpendicular_or_opposed) {
  EXPECT_EQ(kinship(1.0), 1);
  EXPECT_EQ(kinship(0.0), 0);
  EXPECT_EQ(kinship(-1.0), 0);
  for (double c = -1; c <= 1; c += 0.01) EXPECT_GE(kinship(c), 0);
}

}  // namespace
}  // namespace palpate::force
