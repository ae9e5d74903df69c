// SPDX-License-Identifier: Apache-2.0
// Property tests of distance(): every answer is proved (convex_shapes.hpp), over random shapes,
// scales, poses and caches.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "convex_shapes.hpp"

namespace palpate::convex::test {
namespace {

/// The long run defines more.
#ifndef PALPATE_CONVEX_QUERIES
#define PALPATE_CONVEX_QUERIES 600000
#endif
constexpr int kQueries = PALPATE_CONVEX_QUERIES;

/// Shapes are dear, poses cheap: a pool of shapes, paired at random.
std::vector<Shape> shape_pool(std::uint32_t max_vertices, Random& random) {
  std::vector<Shape> pool;
  pool.reserve(400);
  for (int i = 0; i < 400; ++i) pool.push_back(any_shape(max_vertices, random));
  return pool;
}

/// Counts refutations by their words, and the states seen.
struct Tally {
  std::map<std::string, int> wrong;
  int states[4] = {};

  void add(const Hull& a, const Hull& b, const RelativePose& pose, const Distance& d,
           const Cache& cache) {
    ++states[static_cast<int>(d.state)];
    const char* reason = refute(a, b, pose, d, cache);
    if (reason != nullptr) ++wrong[reason];
  }
};

void expect_clean(const Tally& tally) {
  for (const auto& [reason, count] : tally.wrong) ADD_FAILURE() << reason << ": " << count;
}

RelativePose random_pose(Random& random, double reach) {
  return {rotation(random_rotation(random)), reach * random_unit(random)};
}

Cache random_cache(const Hull& a, const Hull& b, Random& random) {
  Cache cache;
  cache.count = static_cast<std::uint32_t>(random() % 5);
  for (std::uint32_t i = 0; i < cache.count; ++i) {
    cache.a[i] = static_cast<std::uint32_t>(random() % a.count);
    cache.b[i] = static_cast<std::uint32_t>(random() % b.count);
  }
  return cache;
}

void run_random(std::uint32_t max_vertices, int queries, std::uint64_t first_seed) {
  Random random(first_seed);
  const std::vector<Shape> pool = shape_pool(max_vertices, random);
  Tally tally;
  for (int i = 0; i < queries; ++i) {
    const Hull a = pool[random() % pool.size()].hull(1);
    const double scale = (random() % 4) == 0 ? std::pow(10.0, uniform(random, -4, 1)) : 1;
    const Hull b = pool[random() % pool.size()].hull(scale);
    const double reach = (random() % 8) == 0 ? 1000 : uniform(random, 0, 1 + scale);
    const RelativePose pose = random_pose(random, reach);
    Cache cache = random_cache(a, b, random);
    const Distance d = distance(a, b, pose, kExact, cache);
    tally.add(a, b, pose, d, cache);
  }
  expect_clean(tally);
  EXPECT_GT(tally.states[static_cast<int>(State::separated)], queries / 10);
  EXPECT_GT(tally.states[static_cast<int>(State::penetrating)], queries / 50);
}

TEST(Distance, random_small_hulls_every_answer_is_proved) { run_random(12, kQueries, 1); }
TEST(Distance, random_middling_hulls_every_answer_is_proved) { run_random(40, kQueries / 2, 2); }
TEST(Distance, random_large_hulls_every_answer_is_proved) { run_random(500, kQueries / 20, 3); }

/// Moves hulls to a chosen gap or depth along the normal just found, where rounding bites most.
TEST(Distance, tiny_gaps_and_depths_every_answer_is_proved) {
  Random random(4);
  const std::vector<Shape> pool = shape_pool(40, random);
  Tally tally;
  for (int i = 0; i < kQueries / 4; ++i) {
    const Hull a = pool[random() % pool.size()].hull();
    const Hull b = pool[random() % pool.size()].hull();
    RelativePose pose = random_pose(random, 2.5);
    Cache cache;
    const Distance far = distance(a, b, pose, kExact, cache);
    if (far.state != State::separated) continue;
    const double gap = std::pow(10.0, uniform(random, -14, -2)) * ((random() & 1) != 0 ? 1 : -1);
    pose.translation += (far.distance - gap) * far.normal;
    if ((random() & 1) != 0) cache.count = 0;
    const Distance near = distance(a, b, pose, kExact, cache);
    tally.add(a, b, pose, near, cache);
    if (gap > 1e-6) {
      EXPECT_NEAR(near.distance, gap, 1e-7);
    }
  }
  expect_clean(tally);
}

/// Faces and edges parallel but for a tilt from nothing to 1e-3.
TEST(Distance, nearly_parallel_features_every_answer_is_proved) {
  Random random(5);
  const Shape shapes[] = {box({0.5, 0.4, 0.3}),
                          prism(6, 0.5, 0.4),
                          prism(40, 0.5, 0.001),
                          triangle({0, 0, 0}, {0.9, 0, 0}, {0, 0.9, 0}),
                          cloud({{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}}),
                          segment({-0.9, 0, 0}, {0.9, 0, 0})};
  Tally tally;
  for (int i = 0; i < kQueries / 4; ++i) {
    const Hull a = shapes[random() % 6].hull();
    const Hull b = shapes[random() % 6].hull();
    const double tilt = (random() % 3) == 0 ? 0 : std::pow(10.0, uniform(random, -17, -3));
    const double turn = 0.5 * std::numbers::pi * static_cast<double>(random() % 4);
    RelativePose pose;
    pose.rotation = rotation(about(random_unit(random), tilt) * about({0, 0, 1}, turn));
    pose.translation = {uniform(random, -1, 1), uniform(random, -1, 1), 0};
    pose.translation.z = (random() & 1) != 0 ? 0.6 : uniform(random, -1, 1);
    Cache cache;
    const Distance d = distance(a, b, pose, kExact, cache);
    tally.add(a, b, pose, d, cache);
  }
  expect_clean(tally);
}

TEST(Distance, coherent_motion_warm_agrees_with_cold) {
  Random random(6);
  const std::vector<Shape> pool = shape_pool(500, random);
  Tally tally;
  std::uint64_t iterations = 0;
  int queries = 0;
  for (int i = 0; i < 200; ++i) {
    const Hull a = pool[random() % pool.size()].hull();
    const Hull b = pool[random() % pool.size()].hull();
    Quat turn = random_rotation(random);
    Vec3d at = 1.5 * random_unit(random);
    const Vec3d axis = random_unit(random);
    const Vec3d step = 0.001 * random_unit(random);
    Cache warm;
    for (int k = 0; k < 100; ++k, ++queries) {
      turn = about(axis, 0.0035) * turn;
      at += step;
      const RelativePose pose{rotation(turn), at};
      const Distance w = distance(a, b, pose, kExact, warm);
      Cache none;
      const Distance c = distance(a, b, pose, kExact, none);
      tally.add(a, b, pose, w, warm);
      tally.add(a, b, pose, c, none);
      iterations += w.iterations;
      if (w.state == State::separated && c.state == State::separated) {
        ASSERT_NEAR(w.distance, c.distance, 1e-9);
      }
    }
  }
  expect_clean(tally);
  EXPECT_LT(static_cast<double>(iterations), 2.0 * queries);
}

/// Calls check(a, b, pose, exact answer, random) for random hulls until it fails.
template <class Check>
void for_random_pairs(unsigned seed, Check check) {
  Random random(seed);
  const std::vector<Shape> pool = shape_pool(60, random);
  for (int i = 0; i < kQueries / 10 && !testing::Test::HasFatalFailure(); ++i) {
    const Hull a = pool[random() % pool.size()].hull();
    const Hull b = pool[random() % pool.size()].hull();
    const RelativePose pose = random_pose(random, 1.5);
    Cache cache;
    check(a, b, pose, distance(a, b, pose, kExact, cache), random);
  }
}

TEST(Distance, enough_above_never_stops_a_nearer_pair) {
  for_random_pairs(7, [](const Hull& a, const Hull& b, const RelativePose& pose,
                         const Distance& exact, Random& random) {
    const double limit = uniform(random, 0, 1);
    Cache cold;
    const Distance early = distance(a, b, pose, {.above = limit}, cold);
    ASSERT_LE(early.lower_bound, exact.distance + 1e-12);
    if (exact.distance < limit) {
      ASSERT_NEAR(early.distance, exact.distance, 3e-9);
    }
    if (exact.lower_bound > limit) {
      ASSERT_GT(early.lower_bound, limit);
    }
  });
}

TEST(Distance, enough_below_never_stops_a_farther_pair) {
  for_random_pairs(8, [](const Hull& a, const Hull& b, const RelativePose& pose,
                         const Distance& exact, Random& random) {
    const double limit = uniform(random, 0, 1);
    Cache cold;
    const Distance early = distance(a, b, pose, {.below = limit}, cold);
    ASSERT_EQ(overlaps(early), overlaps(exact));
    ASSERT_LE(early.lower_bound, exact.distance + 1e-12);
    ASSERT_GE(early.distance, exact.lower_bound - 1e-12);
    if (exact.lower_bound > limit) {
      ASSERT_NEAR(early.distance, exact.distance, 3e-9);
    }
  });
}

TEST(Distance, guess_in_any_direction_changes_no_distance) {
  for_random_pairs(9, [](const Hull& a, const Hull& b, const RelativePose& pose,
                         const Distance& exact, Random& random) {
    Cache cold;
    const Distance guessed = distance(a, b, pose, kExact, cold, random_unit(random));
    ASSERT_EQ(overlaps(guessed), overlaps(exact));
    ASSERT_NEAR(guessed.distance, exact.distance, 3e-9);
  });
}

}  // namespace
}  // namespace palpate::convex::test
