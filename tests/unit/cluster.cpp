// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/cluster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace palpate::force {
namespace {

Contact at(Vec3d point, Vec3d normal, double distance, std::uint32_t pair = 0) {
  Contact c;
  c.point_a_m = point + 0.5 * distance * normal;
  c.point_b_m = point - 0.5 * distance * normal;
  c.normal = normal;
  c.distance_m = distance;
  c.pair = pair;
  return c;
}

struct Outcome {
  Wrench wrench;
  std::uint32_t clusters = 0;
  bool overflow = false;
};

Outcome feel(std::vector<Contact>& contacts, const Settings& settings, std::uint32_t tool = 0,
             std::size_t most = 64) {
  std::vector<Ranked> order(contacts.size());
  std::vector<Cluster> clusters(most);
  const BodyPair pairs[] = {{0, 1}, {2, 0}, {1, 2}};
  Outcome o;
  o.clusters = cluster(contacts, settings.cluster_radius_m, order, clusters, o.overflow);
  o.wrench = penalty_wrench(contacts, std::span(clusters).first(o.clusters), pairs, tool, {0, 0, 0},
                            settings);
  return o;
}

const Settings kSettings{.delta_m = 0.001, .stiffness_N_per_m = 500, .cluster_radius_m = 0.01};

TEST(Cluster, no_contact_gives_no_force) {
  std::vector<Contact> none;
  const Outcome o = feel(none, kSettings);
  EXPECT_EQ(o.clusters, 0u);
  EXPECT_EQ(o.wrench.force_N, (Vec3d{}));
}

TEST(Cluster, coincident_contacts_give_the_wrench_of_one) {
  std::vector<Contact> one{at({0.1, 0, 0}, {0, 0, 1}, 0.0004)};
  std::vector<Contact> many(50, one[0]);
  const Outcome a = feel(one, kSettings);
  const Outcome b = feel(many, kSettings);
  EXPECT_EQ(a.wrench.force_N, b.wrench.force_N);
  EXPECT_EQ(a.wrench.torque_Nm, b.wrench.torque_Nm);
  EXPECT_NEAR(a.wrench.force_N.z, 500 * 0.0006, 1e-12);
  EXPECT_NEAR(a.wrench.torque_Nm.y, -0.1 * 0.3, 1e-12);
  EXPECT_EQ(std::count_if(many.begin(), many.end(), [](const Contact& c) { return c.weight == 1; }),
            1);
}

TEST(Cluster, opposed_normals_make_two_clusters_whose_forces_cancel) {
  std::vector<Contact> peg{at({0, 0, 0}, {0, 0, 1}, 0.0004), at({0, 0, 0}, {0, 0, -1}, 0.0004)};
  const Outcome o = feel(peg, kSettings);
  EXPECT_EQ(o.clusters, 2u);
  EXPECT_NEAR(norm(o.wrench.force_N), 0, 1e-15);
}

TEST(Cluster, far_contacts_make_their_own_clusters) {
  std::vector<Contact> two{at({0, 0, 0}, {0, 0, 1}, 0.0004), at({0.02, 0, 0}, {0, 0, 1}, 0.0002)};
  const Outcome o = feel(two, kSettings);
  EXPECT_EQ(o.clusters, 2u);
  EXPECT_NEAR(o.wrench.force_N.z, 500 * (0.0006 + 0.0008), 1e-12);
}

TEST(Cluster, representative_has_the_least_distance) {
  std::vector<Contact> c{at({0, 0, 0}, {0, 0, 1}, 0.0004), at({0.001, 0, 0}, {0, 0, 1}, -0.0001),
                         at({0.002, 0, 0}, {0, 0, 1}, 0.0009)};
  const Outcome o = feel(c, kSettings);
  EXPECT_EQ(o.clusters, 1u);
  EXPECT_EQ(c[1].weight, 1);
  EXPECT_NEAR(o.wrench.force_N.z, 500 * 0.0011, 1e-12);
}

TEST(Cluster, wrench_does_not_depend_on_the_order_of_contacts) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Contact> c;
  for (int i = 0; i < 200; ++i) {
    Vec3d n{u(rng), u(rng), u(rng)};
    n = (1 / norm(n)) * n;
    c.push_back(at({0.05 * u(rng), 0.05 * u(rng), 0.05 * u(rng)}, n, 0.0009 * u(rng)));
  }
  const Outcome first = feel(c, kSettings, 0, 256);
  for (int k = 0; k < 20; ++k) {
    std::shuffle(c.begin(), c.end(), rng);
    const Outcome again = feel(c, kSettings, 0, 256);
    EXPECT_EQ(again.clusters, first.clusters);
    EXPECT_NEAR(norm(again.wrench.force_N - first.wrench.force_N), 0, 1e-12);
  }
}

TEST(Cluster, pairs_never_share_a_cluster_and_sides_follow_the_tool) {
  std::vector<Contact> c{at({0, 0, 0}, {0, 0, 1}, 0.0004, 0), at({0, 0, 0}, {0, 0, 1}, 0.0004, 1)};
  const Outcome o = feel(c, kSettings);
  EXPECT_EQ(o.clusters, 2u);
  // Body 0 is `a` of pair 0 and `b` of pair 1: pushed along the normal and against it.
  EXPECT_NEAR(norm(o.wrench.force_N), 0, 1e-15);
}

TEST(Cluster, pairs_without_the_tool_add_no_force) {
  std::vector<Contact> c{at({0, 0, 0}, {0, 0, 1}, 0.0004, 2)};
  const Outcome o = feel(c, kSettings);
  EXPECT_EQ(o.clusters, 1u);
  EXPECT_EQ(o.wrench.force_N, (Vec3d{}));
}

TEST(Cluster, full_table_keeps_the_nearest) {
  std::vector<Contact> c;
  for (int i = 0; i < 10; ++i)
    c.push_back(at({0.1 * i, 0, 0}, {0, 0, 1}, 0.0001 * (i + 1) - 0.0005));
  const Outcome o = feel(c, kSettings, 0, 3);
  EXPECT_EQ(o.clusters, 3u);
  EXPECT_TRUE(o.overflow);
  EXPECT_FALSE(feel(c, kSettings, 0, 10).overflow);
  EXPECT_NEAR(o.wrench.force_N.z, 500 * (3 * 0.001 + 0.0004 + 0.0003 + 0.0002), 1e-12);
}

TEST(PenaltyWrench, limits_scale_the_length_and_keep_the_direction) {
  Settings limited = kSettings;
  limited.max_force_N = 0.1;
  limited.max_torque_Nm = 0.001;
  std::vector<Contact> c{at({0.1, 0.2, 0}, {0, 0, 1}, 0.0004)};
  const Outcome free = feel(c, kSettings);
  const Outcome held = feel(c, limited);
  EXPECT_NEAR(norm(held.wrench.force_N), 0.1, 1e-15);
  EXPECT_NEAR(norm(held.wrench.torque_Nm), 0.001, 1e-15);
  EXPECT_NEAR(norm(cross(free.wrench.torque_Nm, held.wrench.torque_Nm)), 0, 1e-15);
}

}  // namespace
}  // namespace palpate::force
