// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/penalty.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "rt_core/geometry/directions.hpp"
#include "tests/support/effort.hpp"

namespace palpate::force {
namespace {

constexpr BodyPair kPairs[] = {{0, 1}, {2, 0}, {1, 2}};

Contact at(Vec3d point, Vec3d normal, double distance, std::uint32_t pair = 0) {
  Contact c;
  c.point_a_m = point + 0.5 * distance * normal;
  c.point_b_m = point - 0.5 * distance * normal;
  c.centre_m = point;
  c.normal = normal;
  c.distance_m = distance;
  c.pair = pair;
  return c;
}

const Settings kSettings{.delta_m = 0.001, .stiffness_N_per_m = 500, .cluster_radius_m = 0.01};

Penalty feel(std::vector<Contact>& contacts, const Settings& settings = kSettings,
             const Pose& pose = {}, std::size_t places = 4096) {
  std::vector<Felt> felt(contacts.size());
  std::vector<Ranked> ranking(contacts.size());
  std::vector<Place> copies(places), table(places);
  const auto cells = std::make_unique<DeepCells>();
  Workspace workspace{felt, ranking, cells.get(), Places(copies), Places(table)};
  return penalty(contacts, kPairs, 0, pose, settings, workspace);
}

Penalty feel(std::vector<Contact>&& contacts, const Settings& settings = kSettings) {
  return feel(contacts, settings);
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

/// The header's formula pair by pair, with tables that have room for all.
Wrench by_definition(const std::vector<Contact>& contacts, const Settings& s) {
  const std::size_t n = contacts.size();
  std::vector<Place> fine(1u << 16), table(1u << 16);
  Places copies(fine), places(table);
  copies.begin(kCopies * s.cluster_radius_m, n);
  places.begin(s.cluster_radius_m, n);
  std::vector<double> mass(n), part(n), depth(n);
  std::vector<Spot> spot(n);
  const auto middle = [&](std::size_t i) {
    return 0.5 * (contacts[i].point_a_m + contacts[i].point_b_m);
  };
  for (std::size_t i = 0; i < n; ++i) {
    depth[i] = std::max(0.0, s.delta_m - contacts[i].distance_m);
    mass[i] = depth[i] * depth[i] / (s.delta_m * s.delta_m);
    spot[i] = copies.add(middle(i), mass[i], mass[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    part[i] = copies.share(spot[i], mass[i]);
    spot[i] = places.add(middle(i), mass[i], part[i]);
  }
  for (std::size_t i = 0; i < n; ++i) mass[i] = places.share(spot[i], part[i]);
  Wrench out;
  for (std::size_t i = 0; i < n; ++i) {
    double around = 0, deepest = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const double c = dot(contacts[i].normal, contacts[j].normal);
      around += kinship(c) * mass[j];
      if (c > 0) deepest = std::max(deepest, kinship(c) * depth[j]);
    }
    if (mass[i] == 0) continue;
    const Vec3d f = (s.stiffness_N_per_m * deepest * mass[i] / around) * contacts[i].normal;
    out.force_N += f;
    out.torque_Nm += cross(contacts[i].centre_m, f);
  }
  return out;
}

TEST(Penalty, shares_forces_by_points_and_has_its_torque_about_centres) {
  Random random{std::mt19937(14)};
  std::vector<Contact> c = random.contacts(30, 0.02);
  const Wrench at_points = by_definition(c, kSettings);
  for (Contact& contact : c) contact.centre_m += random.vector(0.01);
  const Wrench expected = by_definition(c, kSettings);
  const Penalty p = feel(c);
  EXPECT_NEAR(norm(p.wrench.force_N - at_points.force_N), 0, 1e-9);
  EXPECT_NEAR(norm(p.wrench.torque_Nm - expected.torque_Nm), 0, 1e-9);
  EXPECT_GT(norm(expected.torque_Nm - at_points.torque_Nm), 1e-5);
}

TEST(Penalty, no_contact_gives_no_force) {
  const Penalty p = feel(std::vector<Contact>{});
  EXPECT_EQ(p.directions, 0);
  EXPECT_EQ(p.wrench.force_N, (Vec3d{}));
}

TEST(Penalty, one_contact_is_a_spring) {
  std::vector<Contact> one{at({0.1, 0.003, 0}, {0, 0, 1}, 0.0004)};
  const Penalty p = feel(one);
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0006, 1e-12);
  EXPECT_NEAR(p.wrench.torque_Nm.x, 0.003 * 0.3, 1e-12);
  EXPECT_NEAR(p.wrench.torque_Nm.y, -0.1 * 0.3, 1e-12);
  EXPECT_NEAR(one[0].weight, 1, 1e-12);
  EXPECT_NEAR(p.directions, 1, 1e-12);
}

TEST(Penalty, matches_its_definition) {
  Random random{std::mt19937(7)};
  for (int round = 0; round < 40; ++round) {
    std::vector<Contact> c = random.contacts(1 + round, 0.02);
    const Wrench expected = by_definition(c, kSettings);
    const Penalty p = feel(c);
    EXPECT_NEAR(norm(p.wrench.force_N - expected.force_N), 0, 1e-9);
    EXPECT_NEAR(norm(p.wrench.torque_Nm - expected.torque_Nm), 0, 1e-11);
  }
}

/// A ball in a shell, pressed to one side.
TEST(Penalty, matches_its_definition_with_hundreds_of_contacts_all_around) {
  constexpr int kContacts = 450;
  constexpr double kGolden = 2.39996322972865332;  // radians
  std::vector<Contact> c;
  for (int i = 0; i < kContacts; ++i) {
    const double z = 1 - (2 * i + 1.0) / kContacts;
    const double r = std::sqrt(1 - z * z);
    const Vec3d n{r * std::cos(kGolden * i), r * std::sin(kGolden * i), z};
    const double deep = 0.5 + 0.4 * dot(n, {0.6, 0.48, 0.64});
    c.push_back(at(-0.035 * n, n, (1 - deep) * kSettings.delta_m));
  }
  const Wrench expected = by_definition(c, kSettings);
  const Penalty p = feel(c);
  EXPECT_NEAR(norm(p.wrench.force_N - expected.force_N), 0, 1e-4 * norm(expected.force_N));
}

TEST(Penalty, weights_add_up_to_the_wrench) {
  Random random{std::mt19937(8)};
  std::vector<Contact> c = random.contacts(50, 0.02);
  const Penalty p = feel(c);
  Vec3d sum{};
  for (const Contact& contact : c) {
    sum += (contact.weight * 500 * (0.001 - contact.distance_m)) * contact.normal;
  }
  EXPECT_NEAR(norm(sum - p.wrench.force_N), 0, 1e-12);
}

TEST(Penalty, stiffness_tells_how_the_wrench_of_one_contact_falls) {
  const Vec3d point{0.02, -0.01, 0.005}, normal{0.6, 0, 0.8};
  const auto wrench_at = [&](Vec3d shift) {  // of the tool, whose point moves with it
    return feel({at(point, normal, 0.0004 + dot(shift, normal))}).wrench;
  };
  const Penalty p = feel({at(point, normal, 0.0004)});
  const Vec3d shift{1e-7, -2e-7, 3e-7};
  const Vec6 fall = p.stiffness * vec6(shift, {});
  const Wrench moved = wrench_at(shift);
  EXPECT_NEAR(norm(moved.force_N - (p.wrench.force_N - linear(fall))), 0, 1e-12);
  EXPECT_NEAR(norm(moved.torque_Nm - (p.wrench.torque_Nm - angular(fall))), 0, 1e-12);
  const Vec6 turned = p.stiffness * vec6({}, {0, 1e-6, 0});
  EXPECT_NEAR(norm(linear(turned) - 500 * dot(cross(Vec3d{0, 1e-6, 0}, point), normal) * normal), 0,
              1e-15);
}

TEST(Penalty, coincident_contacts_give_the_wrench_of_one) {
  Random random{std::mt19937(9)};
  std::vector<Contact> some = random.contacts(12, 0.03);
  std::vector<Contact> more = some;
  for (std::size_t i = 0; i < 12; ++i) more.insert(more.end(), 10 * i, some[i]);
  const Penalty a = feel(some);
  const Penalty b = feel(more);
  EXPECT_NEAR(norm(a.wrench.force_N - b.wrench.force_N), 0, 1e-12);
  EXPECT_NEAR(norm(a.wrench.torque_Nm - b.wrench.torque_Nm), 0, 1e-14);
}

TEST(Penalty, copies_of_a_contact_do_not_outweigh_others_nearby) {
  Random random{std::mt19937(10)};
  for (int round = 0; round < 20; ++round) {
    std::vector<Contact> some = random.contacts(6, 0.004);
    std::vector<Contact> more = some;
    for (std::size_t i = 0; i < 6; ++i) more.insert(more.end(), 10 * i, some[i]);
    const Penalty a = feel(some);
    const Penalty b = feel(more);
    EXPECT_NEAR(norm(a.wrench.force_N - b.wrench.force_N), 0, 1e-12) << round;
    EXPECT_NEAR(norm(a.wrench.torque_Nm - b.wrench.torque_Nm), 0, 1e-14) << round;
  }
}

TEST(Penalty, contacts_that_meet_become_one_without_a_step) {
  const Contact still = at({0, 0, 0}, {0, 0, 1}, 0.0004),
                other = at({0.004, 0, 0}, {0, 0, 1}, 0.0003);
  const auto torque_at = [&](double x) {
    return feel({still, other, at({x, 0, 0}, {0, 0, 1}, 0.0004)}).wrench.torque_Nm.y;
  };
  const double met = feel({still, other}).wrench.torque_Nm.y;
  EXPECT_NEAR(torque_at(1e-9), met, 1e-8);
  double before = torque_at(0.002);
  for (double x = 0.002; x > 0; x -= 1e-6) {
    const double now = torque_at(x);
    EXPECT_NEAR(now, before, 2e-6);
    before = now;
  }
}

TEST(Penalty, coincident_contacts_hide_none_behind_them) {
  const auto tilted = [](double x, double distance_m) {
    const double z = std::sqrt(1 - x * x);
    return at({x, 0, 0}, {x, 0, z}, distance_m);
  };
  std::vector<Contact> some{tilted(0.64, 0), tilted(-0.64, 1e-4), tilted(-0.57, 9e-4)};
  std::vector<Contact> more = some;
  more.insert(more.end(), 100, some[0]);
  const Penalty a = feel(some);
  const Penalty b = feel(more);
  EXPECT_NEAR(norm(a.wrench.force_N - b.wrench.force_N), 0, 1e-12);
  EXPECT_NEAR(norm(a.wrench.torque_Nm - b.wrench.torque_Nm), 0, 1e-12);
}

TEST(Penalty, order_of_contacts_does_not_matter) {
  Random random{std::mt19937(3)};
  std::vector<Contact> c = random.contacts(200, 0.05);
  for (std::size_t i = 0; i < 50; ++i) c[i].distance_m = 0.0003;  // ties
  const Penalty first = feel(c);
  for (int k = 0; k < 20; ++k) {
    std::shuffle(c.begin(), c.end(), random.rng);
    const Penalty again = feel(c);
    EXPECT_NEAR(norm(again.wrench.force_N - first.wrench.force_N), 0, 1e-12);
    EXPECT_NEAR(norm(again.wrench.torque_Nm - first.wrench.torque_Nm), 0, 1e-13);
  }
}

TEST(Penalty, wide_contact_of_one_normal_gives_its_largest_depth_however_it_is_cut) {
  for (const int cuts : {1, 2, 5, 40}) {
    std::vector<Contact> c;
    for (int i = 0; i < cuts * cuts; ++i) {
      const double x = (i % cuts + 0.5) / cuts - 0.5, y = (i / cuts + 0.5) / cuts - 0.5;
      c.push_back(at({0.1 * x, 0.1 * y, 0}, {0, 0, 1}, 0.0002 + 0.001 * (x * x + y * y)));
    }
    c.push_back(at({}, {0, 0, 1}, 0.0002));
    const Penalty p = feel(c);
    EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0008, 1e-12) << cuts;
    EXPECT_NEAR(norm(p.wrench.torque_Nm), 0, 2e-3 * 0.4) << cuts;
  }
}

TEST(Penalty, peg_on_both_ends_turns_back_like_two_springs) {
  constexpr double kHalf_m = 0.05, kAngle_rad = 1e-6, kDepth_m = 0.0005;
  const Penalty p = feel({at({kHalf_m, 0, 0}, {0, 0, 1}, 0.0005 - kAngle_rad * kHalf_m),
                          at({-kHalf_m, 0, 0}, {0, 0, 1}, 0.0005 + kAngle_rad * kHalf_m)});
  EXPECT_NEAR(p.wrench.force_N.z, 500 * kDepth_m, 2e-4 * 500 * kDepth_m);
  const double two_springs_Nm = 2 * 500 * kHalf_m * kHalf_m * kAngle_rad;
  EXPECT_NEAR(-p.wrench.torque_Nm.y, two_springs_Nm, 1e-3 * two_springs_Nm);
}

TEST(Penalty, triangles_at_one_end_of_a_peg_do_not_pull_the_force_there) {
  std::vector<Contact> c{at({-0.05, 0, 0}, {0, 0, 1}, 0.0004)};
  for (int i = 0; i < 500; ++i) c.push_back(at({0.05, 1e-7 * i, 0}, {0, 0, 1}, 0.0004));
  EXPECT_NEAR(feel(c).wrench.torque_Nm.y, 0, 0.3 * 0.05 * 0.01);
}

TEST(Penalty, opposed_normals_keep_their_forces) {
  std::vector<Contact> peg{at({0, 0, 0}, {0, 0, 1}, 0.0004), at({0, 0, 0}, {0, 0, -1}, 0.0004)};
  const Penalty p = feel(peg);
  EXPECT_NEAR(norm(p.wrench.force_N), 0, 1e-15);
  EXPECT_NEAR(p.directions, 2, 1e-9);
  EXPECT_NEAR(feel({peg[0], at({0, 0, 0}, {0, 0, -1}, 0.0001)}).wrench.force_N.z,
              500 * (0.0006 - 0.0009), 1e-9);
}

TEST(Penalty, what_cancels_but_for_rounding_cancels) {
  Random random{std::mt19937(14)};
  std::vector<Contact> around;
  for (int i = 0; i < 200; ++i) {
    const Vec3d place = random.vector(0.05);
    const Vec3d normal = random.direction();
    const double distance_m = random(-0.0005, 0.001);
    around.push_back(at(place, normal, distance_m));
    around.push_back(at(-place, -normal, distance_m));
  }
  const Penalty p = feel(around);
  EXPECT_EQ(p.wrench.force_N, Vec3d{});
  around[7].distance_m -= 1e-12;  // a thousandth of a nanometre is not rounding
  const double left_N = norm(feel(around).wrench.force_N);
  EXPECT_GT(left_N, 0);
  EXPECT_LT(left_N, 1e-6);
}

TEST(Penalty, perpendicular_walls_do_not_feel_each_other) {
  const Penalty p = feel({at({0, 0, 0}, {1, 0, 0}, 0.0004), at({0, 0, 0}, {0, 1, 0}, 0.0001),
                          at({0, 0, 0}, {0, 0, 1}, -0.0002)});
  EXPECT_NEAR(p.wrench.force_N.x, 500 * 0.0006, 1e-9);
  EXPECT_NEAR(p.wrench.force_N.y, 500 * 0.0009, 1e-9);
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0012, 1e-9);
}

TEST(Penalty, normals_all_around_count_as_the_faces_of_a_box) {
  Random random{std::mt19937(4)};
  std::vector<Contact> c;
  Settings apart = kSettings;
  apart.cluster_radius_m = 1e-6;
  for (int i = 0; i < 8000; ++i) c.push_back(at(random.vector(0.05), random.direction(), 0));
  const Penalty p = feel(c, apart);
  EXPECT_NEAR(p.directions, 6, 0.1);
  EXPECT_LT(norm(p.wrench.force_N), 0.1 * 500 * 0.001);
}

TEST(Penalty, contact_at_delta_brings_nothing) {
  Random random{std::mt19937(5)};
  std::vector<Contact> c = random.contacts(20, 0.02);
  const Penalty without = feel(c);
  for (const double distance : {0.001, 0.001 - 1e-12}) {
    std::vector<Contact> with = c;
    with.push_back(at(random.vector(0.02), random.direction(), distance));
    const Penalty p = feel(with);
    EXPECT_NEAR(norm(p.wrench.force_N - without.wrench.force_N), 0, 1e-8);
  }
}

/// Along a straight change of every point, normal and distance, halving the step halves the largest
/// change of the wrench: no jumps anywhere.
TEST(Penalty, changes_no_faster_than_its_contacts) {
  Random random{std::mt19937(6)};
  for (int round = 0; round < test::effort(6, 2); ++round) {
    const std::vector<Contact> from = random.contacts(30, 0.03);
    const std::vector<Contact> to = random.contacts(30, 0.03);
    const auto largest_change = [&](int steps) {
      double most = 0;
      Wrench before;
      for (int k = 0; k <= steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        std::vector<Contact> c;
        for (std::size_t i = 0; i < from.size(); ++i) {
          const Vec3d n = (1 - t) * from[i].normal + t * to[i].normal;
          c.push_back(at((1 - t) * from[i].point_a_m + t * to[i].point_a_m, (1 / norm(n)) * n,
                         (1 - t) * from[i].distance_m + t * to[i].distance_m));
        }
        const Wrench now = feel(c).wrench;
        const double change =
            norm(now.force_N - before.force_N) + norm(now.torque_Nm - before.torque_Nm) / 0.03;
        if (k > 0) most = std::max(most, change);
        before = now;
      }
      return most;
    };
    EXPECT_LT(largest_change(4000), 0.6 * largest_change(2000));
    EXPECT_LT(largest_change(2000), 0.01 * 500 * 0.0015 * 6);
  }
}

TEST(Penalty, moves_with_the_scene) {
  Random random{std::mt19937(11)};
  std::vector<Contact> c = random.contacts(40, 0.02);
  const Penalty p = feel(c);
  Pose pose;
  pose.position_m = {1, -2, 0.5};
  pose.orientation = {0.5, 0.5, -0.5, 0.5};
  const Mat3d turn = rotation(pose.orientation);
  std::vector<Contact> moved = c;
  for (Contact& m : moved) {
    m.point_a_m = turn * m.point_a_m + pose.position_m;
    m.point_b_m = turn * m.point_b_m + pose.position_m;
    m.centre_m = turn * m.centre_m + pose.position_m;
    m.normal = turn * m.normal;
  }
  const Penalty q = feel(moved, kSettings, pose);
  EXPECT_NEAR(norm(q.wrench.force_N - turn * p.wrench.force_N), 0, 1e-9);
  EXPECT_NEAR(norm(q.wrench.torque_Nm - turn * p.wrench.torque_Nm), 0, 1e-11);
}

TEST(Penalty, pushes_the_tool_whichever_side_of_a_pair_it_is) {
  const Penalty p =
      feel({at({0, 0, 0}, {0, 0, 1}, 0.0004, 0), at({0, 0, 0}, {0, 0, -1}, 0.0004, 1)});
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0006, 1e-12);  // two bodies, one direction: felt once
}

TEST(Penalty, pairs_without_the_tool_add_no_force) {
  std::vector<Contact> c{at({0, 0, 0}, {0, 0, 1}, 0.0004, 2)};
  const Penalty p = feel(c);
  EXPECT_EQ(p.wrench.force_N, (Vec3d{}));
  EXPECT_EQ(c[0].weight, 0);
}

TEST(Penalty, full_table_of_places_keeps_the_force) {
  std::vector<Contact> c;
  for (int i = 0; i < 100; ++i) c.push_back(at({0.1 * i, 0, 0}, {0, 0, 1}, 0.0005));
  const Penalty p = feel(c, kSettings, {}, 3);
  EXPECT_TRUE(p.places_full);
  EXPECT_FALSE(feel(c).places_full);
  EXPECT_NEAR(p.wrench.force_N.z, 500 * 0.0005, 1e-12);
}

// Contacts on the planes of the grid: a corner that rounding adds, with a share of 1e-16, must not
// take the room of another.
TEST(Penalty, rounding_does_not_choose_what_finds_room_in_a_full_table) {
  Random random{std::mt19937(13)};
  std::vector<Contact> c;
  for (int i = 0; i < 2000; ++i) {
    const int x = i % 10, y = i / 10 % 10, z = i / 100;
    const Vec3d place = 0.5 * kSettings.cluster_radius_m * Vec3d{1.0 * x, 1.0 * y, 1.0 * z};
    const Vec3d normal = random.direction();
    c.push_back(at(place, normal, random(-0.0005, 0.001)));
  }
  std::vector<Contact> rounded = c;
  for (Contact& r : rounded) {
    const Vec3d off = random.vector(1e-16);
    r.point_a_m += off;
    r.point_b_m += off;
  }
  const Penalty p = feel(c, kSettings, {}, 500);
  const Penalty q = feel(rounded, kSettings, {}, 500);
  EXPECT_TRUE(p.places_full);
  EXPECT_GT(norm(p.wrench.force_N), 0.01);
  EXPECT_NEAR(norm(q.wrench.force_N - p.wrench.force_N), 0, 1e-9);
}

TEST(Penalty, scales_from_micrometres_to_kilometres) {
  for (const double scale : {1e-9, 1e-3, 1.0, 1e6}) {
    Settings s = kSettings;
    s.delta_m *= scale;
    s.cluster_radius_m *= scale;
    s.stiffness_N_per_m /= scale;
    Random random{std::mt19937(12)};
    std::vector<Contact> c = random.contacts(30, 0.02);
    const Penalty p = feel(c);
    for (Contact& contact : c) {
      contact.point_a_m = scale * contact.point_a_m;
      contact.point_b_m = scale * contact.point_b_m;
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

TEST(Directions, moments_give_the_sum_over_pairs) {
  Random random{std::mt19937(13)};
  Directions directions;
  std::vector<std::pair<Vec3d, double>> masses;
  for (int i = 0; i < 100; ++i) {
    masses.emplace_back(random.direction(), random(0, 2));
    directions.add(masses.back().first, masses.back().second);
  }
  for (int i = 0; i < 100; ++i) {
    const Vec3d n = random.direction();
    double sum = 0;
    for (const auto& [direction, mass] : masses) sum += mass * kinship(dot(n, direction));
    EXPECT_NEAR(directions.around(n), sum, 1e-12);
  }
}

}  // namespace
}  // namespace palpate::force
