// SPDX-License-Identifier: Apache-2.0
// Pairs kept of a region: the nearest of many, and how far the nearest is that has to go.
#include "rt_core/regions/near_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace palpate::test {
namespace {

using regions::kFarthest;
using regions::kNearPairs;
using regions::NearPairs;
using regions::Witness;

/// Pair i of `count`, whose distances are 1 to count in an order that is neither.
Witness scattered(std::uint32_t i, std::uint32_t count) {
  constexpr std::uint32_t kStride = 61;  // prime to all counts here
  return {i, 7 * i, static_cast<float>(1 + i * kStride % count)};
}

std::vector<float> distances_of(const NearPairs& near) {
  std::vector<float> distances;
  for (std::uint32_t k = 0; k < near.count; ++k) distances.push_back(near.pairs[k].distance);
  std::sort(distances.begin(), distances.end());
  return distances;
}

TEST(RegionNearPairs, take_what_others_keep) {
  NearPairs others;
  others.room = 20;
  for (std::uint32_t i = 0; i < 100; ++i) others.add(scattered(i, 100), kFarthest);
  NearPairs near;
  for (std::uint32_t i = 0; i < 50; ++i) near.add(scattered(i, 50), kFarthest);
  near.take(others);
  EXPECT_EQ(near.room, 20u);
  EXPECT_EQ(distances_of(near), distances_of(others));
  EXPECT_EQ(near.add(scattered(99, 100), kFarthest), others.add(scattered(99, 100), kFarthest));
}

TEST(RegionNearPairs, keep_the_nearest_and_tell_the_nearest_that_was_dropped) {
  for (const std::uint32_t count : {1u, kNearPairs - 1, kNearPairs, kNearPairs + 1, 1000u}) {
    NearPairs near;
    float dropped = kFarthest;
    for (std::uint32_t i = 0; i < count; ++i) {
      dropped = std::min(dropped, near.add(scattered(i, count), kFarthest));
    }
    const std::uint32_t kept = std::min(count, kNearPairs);
    const std::vector<float> distances = distances_of(near);
    ASSERT_EQ(distances.size(), kept);
    for (std::uint32_t k = 0; k < kept; ++k) ASSERT_EQ(distances[k], static_cast<float>(k + 1));
    EXPECT_EQ(dropped, count > kept ? static_cast<float>(kept + 1) : kFarthest);
  }
}

TEST(RegionNearPairs, are_no_more_than_there_is_room_for) {
  NearPairs near;
  near.room = 10;
  for (std::uint32_t i = 0; i < 100; ++i) near.add(scattered(i, 100), kFarthest);
  const std::vector<float> kept = distances_of(near);
  EXPECT_EQ(kept, std::vector<float>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST(RegionNearPairs, stay_with_their_distances) {
  NearPairs near;
  for (std::uint32_t i = 0; i < 500; ++i) near.add(scattered(i, 500), kFarthest);
  for (std::uint32_t k = 0; k < near.count; ++k) {
    const Witness& pair = near.pairs[k];
    EXPECT_EQ(pair.b, 7 * pair.a);
    EXPECT_EQ(pair.distance, scattered(pair.a, 500).distance);
  }
}

TEST(RegionNearPairs, are_sorted_by_distance) {
  for (const std::uint32_t count : {0u, 1u, 2u, kNearPairs - 1, 700u}) {
    NearPairs near;
    for (std::uint32_t i = 0; i < count; ++i) near.add(scattered(i, count), kFarthest);
    near.sort();
    ASSERT_EQ(near.count, std::min(count, kNearPairs));
    for (std::uint32_t k = 0; k < near.count; ++k) {
      EXPECT_EQ(near.pairs[k].distance, static_cast<float>(k + 1));
      EXPECT_EQ(near.pairs[k].distance, scattered(near.pairs[k].a, count).distance);
    }
  }
}

}  // namespace
}  // namespace palpate::test
