// SPDX-License-Identifier: Apache-2.0
// Seeds of a region: what is one place, what has to go where there is no room.
#include "rt_core/regions/seeds.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace palpate::test {
namespace {

using regions::kSeeds;
using regions::Seeds;
using regions::Witness;

/// A region of radius 1 with triangles a tenth apart in a row.
struct Row {
  Row() : triangles(64) {
    region.radius = 1;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      triangles[i] = {};
      triangles[i].corners[0] = 0.1f * static_cast<float>(i);
    }
    view.region_triangles = triangles;
    view.regions = {&region, 1};
  }
  std::vector<image::RegionTriangle> triangles;
  image::Region region{};
  ImageView view;
};

Seeds full(const Row& row) {
  Seeds seeds;
  for (std::uint32_t i = 0; i < kSeeds; ++i) {
    note_seed(row.view, {2 * i, 100 + i, 0.1f * static_cast<float>(i + 1)}, seeds);
  }
  return seeds;
}

bool holds(const Seeds& seeds, const Witness& pair) {
  for (std::uint32_t i = 0; i < seeds.count; ++i) {
    const Witness seed = seeds.at(i);
    if (seed.same_pair(pair) && seed.distance == pair.distance) return true;
  }
  return false;
}

TEST(RegionSeeds, places_apart_are_kept_side_by_side) {
  const Row row;
  const Seeds seeds = full(row);
  EXPECT_EQ(seeds.count, kSeeds);
  for (std::uint32_t i = 0; i < kSeeds; ++i) {
    EXPECT_TRUE(holds(seeds, {2 * i, 100 + i, 0.1f * static_cast<float>(i + 1)}));
  }
}

TEST(RegionSeeds, of_one_place_the_nearer_is_kept) {
  const Row row;
  Seeds seeds;
  note_seed(row.view, {10, 100, 0.5f}, seeds);
  note_seed(row.view, {11, 101, 0.4f}, seeds);  // beside it
  note_seed(row.view, {11, 102, 0.6f}, seeds);  // farther
  note_seed(row.view, {40, 101, 0.3f}, seeds);  // the same triangle of b
  EXPECT_EQ(seeds.count, 1u);
  EXPECT_TRUE(holds(seeds, {40, 101, 0.3f}));
  note_seed(row.view, {40, 101, 0.7f}, seeds);  // the pair itself, measured anew
  EXPECT_TRUE(holds(seeds, {40, 101, 0.7f}));
}

TEST(RegionSeeds, one_that_is_measured_anew_keeps_its_place) {
  const Row row;
  Seeds seeds = full(row);
  EXPECT_TRUE(measure_seed({4, 102, 9}, seeds));
  EXPECT_TRUE(holds(seeds, {4, 102, 9}));
  EXPECT_EQ(seeds.count, kSeeds);
  EXPECT_FALSE(measure_seed({4, 103, 0.01f}, seeds));  // of two seeds, a triangle each
  EXPECT_TRUE(holds(seeds, {4, 102, 9}));
  seeds.count = 2;
  EXPECT_FALSE(measure_seed({4, 102, 1}, seeds));  // no longer one of them
}

TEST(RegionSeeds, the_farthest_goes_first) {
  const Row row;
  Seeds seeds = full(row);
  note_seed(row.view, {60, 200, 5}, seeds);
  EXPECT_FALSE(holds(seeds, {60, 200, 5}));
  note_seed(row.view, {60, 200, 0.05f}, seeds);
  EXPECT_TRUE(holds(seeds, {60, 200, 0.05f}));
  EXPECT_FALSE(holds(seeds, {2 * (kSeeds - 1), 100 + kSeeds - 1, 0.1f * float(kSeeds)}));
  EXPECT_EQ(seeds.count, kSeeds);
}

TEST(RegionSeeds, one_that_comes_to_anothers_place_leaves_room) {
  const Row row;
  Seeds seeds = full(row);
  move_seed(row.view, 0, {3, 300, 0.15f}, seeds);  // beside the second, and nearer
  EXPECT_EQ(seeds.count, kSeeds - 1);
  EXPECT_TRUE(holds(seeds, {3, 300, 0.15f}));
  const Witness stays = seeds.at(4);
  move_seed(row.view, 4, {stays.a, stays.b, 9}, seeds);
  EXPECT_TRUE(holds(seeds, {stays.a, stays.b, 9}));
  EXPECT_EQ(seeds.count, kSeeds - 1);
}

}  // namespace
}  // namespace palpate::test
