// SPDX-License-Identifier: Apache-2.0
// The least push: what one, many, parallel, coincident and opposed contacts give.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "rt_core/force/least_push.hpp"

namespace palpate::test {
namespace {

using force::least_push;
using force::PushConstraint;
using force::PushResult;
using force::PushStatus;

Vec3d unit(Vec3d v) { return (1 / norm(v)) * v; }

Vec3d random_unit(std::mt19937& rng) {
  std::normal_distribution<double> d;
  return unit({d(rng), d(rng), d(rng)});
}

/// The force is 2 k v: this is 2 v.
Vec3d twice(const PushResult& r) { return 2.0 * r.push.vector; }

void expect_near(Vec3d a, Vec3d b, double tolerance) {
  EXPECT_LT(norm(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

void expect_optimal(const std::vector<PushConstraint>& all, const PushResult& r) {
  EXPECT_EQ(r.status, PushStatus::solved);
  double largest = 0;
  for (const PushConstraint& c : all) largest = std::max(largest, c.strength);
  for (const PushConstraint& c : all) {
    EXPECT_GE(r.push.along(c.normal), c.strength - 1e-8 * largest);
  }
  force::Push sum;
  for (std::uint32_t i = 0; i < r.carrying_count; ++i) {
    const PushConstraint& c = all[r.carrying[i].index];
    EXPECT_GT(r.carrying[i].multiplier, 0);
    EXPECT_NEAR(r.push.along(c.normal), c.strength, 1e-7 * largest);
    sum.vector += r.carrying[i].multiplier * c.normal;
  }
  expect_near(sum.vector, r.push.vector, 1e-9 * largest + 1e-300);
}

TEST(LeastPush, nothing_and_what_is_too_far_push_nothing) {
  EXPECT_EQ(least_push({}).carrying_count, 0u);
  const PushConstraint far[] = {{{0, 0, 1}, -0.2}, {{1, 0, 0}, 0}};
  EXPECT_EQ(norm(least_push(far).push.vector), 0);
}

TEST(LeastPush, one_contact_pushes_by_its_strength_and_copies_add_nothing) {
  for (const std::size_t copies : {1u, 2u, 100u}) {
    const std::vector<PushConstraint> all(copies, {unit({1, 2, 3}), 0.25});
    const PushResult r = least_push(all);
    expect_near(twice(r), 0.25 * unit({1, 2, 3}), 1e-10);
    expect_optimal(all, r);
  }
}

TEST(LeastPush, of_one_direction_the_strongest_counts) {
  const PushConstraint all[] = {{{0, 0, 1}, 0.1}, {{0, 0, 1}, 0.3}, {{0, 0, 1}, 0.2}};
  expect_near(twice(least_push(all)), {0, 0, 0.3}, 1e-10);
}

TEST(LeastPush, walls_square_to_each_other_add) {
  const PushConstraint all[] = {{{0, 0, 1}, 0.1}, {{1, 0, 0}, 0.3}, {{0, -1, 0}, 0.2}};
  expect_near(twice(least_push(all)), {0.3, -0.2, 0.1}, 1e-10);
}

TEST(LeastPush, opposed_walls_leave_the_difference) {
  const PushConstraint all[] = {{{0, 0, 1}, 0.5}, {{0, 0, -1}, 0.2}};
  expect_near(twice(least_push(all)), {0, 0, 0.3}, 1e-10);
  const PushConstraint equal[] = {{{0, 0, 1}, 0.5}, {{0, 0, -1}, 0.5}};
  const PushResult r = least_push(equal);
  EXPECT_LT(norm(twice(r)), 1e-12);
  EXPECT_EQ(r.carrying_count, 2u);
}

TEST(LeastPush, directions_one_rounding_apart_are_one) {
  const double tiny = 1e-16;
  const PushConstraint all[] = {
      {{0, 0, 1}, 0.3}, {unit({tiny, 0, 1}), 0.3}, {unit({0, 1e-9, 1}), 0.3}};
  expect_near(twice(least_push(all)), {0, 0, 0.3}, 1e-8);
}

TEST(LeastPush, random_sets_are_optimal_whatever_they_begin_with) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> strength(-0.2, 1);
  std::uniform_int_distribution<std::size_t> count(1, 200);
  for (int round = 0; round < 300; ++round) {
    std::vector<PushConstraint> all(count(rng));
    for (PushConstraint& c : all) c = {random_unit(rng), strength(rng)};
    const PushResult cold = least_push(all);
    expect_optimal(all, cold);
    const std::uint32_t start[] = {0, static_cast<std::uint32_t>(all.size() - 1), 0, 1000};
    const PushResult warm = least_push(all, start);
    expect_near(warm.push.vector, cold.push.vector, 1e-7);
  }
}

/// A round tool in a round hole: all contacts of each ring carry, any ten of them depend on each
/// other, and rounding decides which of them stay.
TEST(LeastPush, rings_of_contacts_are_optimal_as_they_become_more) {
  constexpr std::size_t kCorners = 24;
  std::mt19937 rng(3);
  std::vector<PushConstraint> all;
  for (const double up : {0.065, 0.195, 0.44, 0.75, 0.998}) {
    const double out = std::sqrt(1 - up * up);
    for (std::size_t i = 0; i < kCorners; ++i) {
      const double a = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kCorners;
      all.push_back({{out * std::cos(a), out * std::sin(a), up}, 0.42 + 0.54 * up});
    }
  }
  for (int round = 0; round < 300; ++round) {
    std::shuffle(all.begin(), all.end(), rng);
    std::vector<std::uint32_t> start;
    for (std::size_t count = 10; count <= all.size(); count += 10) {
      const std::vector<PushConstraint> known(all.data(), all.data() + count);
      const PushResult r = least_push(known, start);
      expect_optimal(known, r);
      start.clear();
      for (const force::Carrying& c : r.carrying_contacts()) start.push_back(c.index);
    }
  }
}

/// However many contacts there are: the force follows a motion by at most 2 k.
TEST(LeastPush, changes_by_no_more_than_twice_the_motion) {
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> strength(0, 1);
  for (int round = 0; round < 200; ++round) {
    std::vector<PushConstraint> all(60);
    for (PushConstraint& c : all) c = {random_unit(rng), strength(rng)};
    const Vec3d before = twice(least_push(all));
    const Vec3d motion = 1e-3 * random_unit(rng);
    for (PushConstraint& c : all) c.strength -= dot(c.normal, motion);
    EXPECT_LE(norm(twice(least_push(all)) - before), 2 * norm(motion) * (1 + 1e-6));
  }
}

/// What is left out may change the push by no more than is said.
TEST(LeastPush, error_of_a_part_of_the_contacts_is_bounded) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> strength(0, 1);
  for (int round = 0; round < 200; ++round) {
    std::vector<PushConstraint> all(40);
    for (PushConstraint& c : all) c = {random_unit(rng), strength(rng)};
    const PushResult whole = least_push(all);
    const PushResult part = least_push(std::span(all).first(10));
    double missing = 0;
    for (const PushConstraint& c : all) {
      missing = std::max(missing, c.strength - part.push.along(c.normal));
    }
    EXPECT_LE(norm(whole.push.vector - part.push.vector),
              force::push_error(part.push, missing) + 1e-9);
  }
}

}  // namespace
}  // namespace palpate::test
