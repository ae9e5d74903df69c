// SPDX-License-Identifier: GPL-3.0-or-later
// What is looked up: near what lies there, spread over a region, within the image.
#include "rt_core/regions/look.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "rt_core/regions/pair_frame.hpp"
#include "tests/support/baked_scene.hpp"
#include "tests/support/shapes.hpp"

namespace palpate::test {
namespace {

const BakedBody& ball() {
  static const BakedBody body(bumpy_ball(40, 60, 1), bake::ForEngine::regions);
  return body;
}

const regions::Kernels& kernels() { return regions::best_kernels(); }

/// Both lie in one place.
regions::PairFrame coincident(const ImageView& view) {
  regions::PairFrame frame;
  frame.a = frame.b = &view;
  frame.a_to_b = frame.b_to_a = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, 1};
  return frame;
}

Vec3d centre_of(const image::RegionTriangle& t) {
  Vec3d sum{};
  for (std::size_t c = 0; c < 3; ++c) {
    sum +=
        Vec3d{double(t.corners[3 * c]), double(t.corners[3 * c + 1]), double(t.corners[3 * c + 2])};
  }
  return (1.0 / 3) * sum;
}

TEST(RegionLook, What_is_found_is_a_cell_away_at_most) {
  const ImageView& view = ball().view;
  ASSERT_NE(view.proximity_grid, nullptr);
  const regions::PairFrame frame = coincident(view);
  ASSERT_TRUE(regions::can_look(frame));
  double longest = 0;  // from a triangle's centre to a corner
  for (const image::RegionTriangle& t : view.region_triangles) {
    const Vec3d corner{double(t.corners[0]), double(t.corners[1]), double(t.corners[2])};
    longest = std::max(longest, norm(centre_of(t) - corner));
  }
  // To the centre of the cell and from there to a triangle that is no farther than the one that
  // was looked from; to the centre of that.
  const double most = std::sqrt(3.0) * double(view.proximity_grid->cell) + 2 * longest;
  for (std::uint32_t region = 0; region < view.regions.size(); ++region) {
    regions::Looks looks;
    regions::look_over(frame, region, 3, regions::kMostLooks, looks);
    regions::look_from(kernels(), frame, looks);
    for (std::uint32_t i = 0; i < looks.count; ++i) {
      const regions::Witness pair = looks.pair(i);
      EXPECT_EQ(view.region_triangles[pair.a].region, region);
      EXPECT_LE(
          norm(centre_of(view.region_triangles[pair.a]) - centre_of(view.region_triangles[pair.b])),
          most);
    }
  }
}

TEST(RegionLook, What_a_look_finds_is_named_at_the_triangles_centre) {
  const ImageView& view = ball().view;
  regions::PairFrame frame = coincident(view);
  const float turned[9] = {0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f};
  std::copy_n(turned, 9, frame.a_to_b.rotation);
  frame.a_to_b.translation[1] = 0.3f;
  for (std::uint32_t region = 0; region < view.regions.size(); ++region) {
    regions::Looks looks;
    regions::look_over(frame, region, 0, 1 + region % regions::kMostLooks, looks);
    regions::look_from(kernels(), frame, looks);
    for (std::uint32_t i = 0; i < looks.count; ++i) {
      const image::RegionTriangle& t = view.region_triangles[looks.a[i]];
      ASSERT_FALSE(regions::is_long(t, view.proximity_grid->cell));
      const Vec3f place = regions::at_place(frame.a_to_b, regions::centre_of(t));
      EXPECT_EQ(looks.b[i], regions::near_place(frame, place)) << region << ", " << i;
    }
  }
}

TEST(RegionLook, Looks_in_a_row_are_of_different_triangles) {
  const ImageView& view = ball().view;
  const regions::PairFrame frame = coincident(view);
  for (std::uint32_t region = 0; region < view.regions.size(); ++region) {
    const std::uint32_t triangles = view.region_runs[region].count;
    const std::uint32_t count = std::min(triangles / 2, regions::kMostLooks);
    for (const std::uint32_t from : {0u, 5u, 0xfffffff8u}) {
      regions::Looks looks;
      regions::look_over(frame, region, from, count, looks);
      std::set<std::uint32_t> seen;
      for (std::uint32_t i = 0; i < count; ++i) seen.insert(looks.a[i]);
      EXPECT_EQ(seen.size(), count) << "region " << region << " of " << triangles;
    }
  }
}

TEST(RegionLook, Looks_beside_a_triangle_are_of_the_others_of_its_region_that_follow_one_another) {
  const ImageView& view = ball().view;
  const regions::PairFrame frame = coincident(view);
  for (std::uint32_t region = 0; region < view.regions.size(); ++region) {
    const image::RegionRun run = view.region_runs[region];
    const std::uint32_t last = run.first + run.count - 1;
    for (const std::uint32_t triangle : {run.first, run.first + run.count / 2, last}) {
      for (const std::uint32_t count : {1u, 6u, regions::kMostLooks}) {
        regions::Looks looks;
        regions::look_beside(frame, region, triangle, count, looks);
        regions::look_from(kernels(), frame, looks);
        ASSERT_EQ(looks.count, std::min(count, run.count - 1));
        for (std::uint32_t i = 0; i < looks.count; ++i) {
          const regions::Witness pair = looks.pair(i);
          EXPECT_EQ(view.region_triangles[pair.a].region, region);
          EXPECT_NE(pair.a, triangle);
          EXPECT_LE(std::max(pair.a, triangle) - std::min(pair.a, triangle), count);
          EXPECT_LT(pair.b, view.region_triangles.size());
        }
      }
    }
  }
}

TEST(RegionLook, Looks_of_several_regions_go_together) {
  const ImageView& view = ball().view;
  const regions::PairFrame frame = coincident(view);
  ASSERT_GE(view.regions.size(), 3u);
  regions::Looks together;
  regions::look_over(frame, 0, 7, 5, together);
  regions::look_beside(frame, 1, view.region_runs[1].first, 4, together);
  regions::look_over(frame, 2, 0, 6, together);
  ASSERT_EQ(together.count, 15u);
  regions::look_from(kernels(), frame, together);
  regions::Looks alone[3];
  regions::look_over(frame, 0, 7, 5, alone[0]);
  regions::look_beside(frame, 1, view.region_runs[1].first, 4, alone[1]);
  regions::look_over(frame, 2, 0, 6, alone[2]);
  std::uint32_t i = 0;
  for (regions::Looks& looks : alone) {
    regions::look_from(kernels(), frame, looks);
    for (std::uint32_t k = 0; k < looks.count; ++k, ++i) {
      EXPECT_TRUE(together.pair(i).same_pair(looks.pair(k)));
    }
  }
  EXPECT_EQ(i, together.count);
}

/// A needle through a ball: all of its surface is far from the needle's centre.
TEST(RegionLook, A_long_triangle_is_looked_from_all_along) {
  const BakedBody needle(cylinder(3, 0.01, 1), bake::ForEngine::regions);
  regions::PairFrame frame = coincident(ball().view);
  frame.a = &needle.view;
  for (std::uint32_t region = 0; region < needle.view.regions.size(); ++region) {
    const std::uint32_t first = needle.view.region_runs[region].first;
    if (!regions::is_long(needle.view.region_triangles[first], frame.b->proximity_grid->cell))
      continue;
    regions::Looks looks;
    regions::look_over(frame, region, 0, regions::kMostLooks, looks);
    regions::look_from(kernels(), frame, looks);
    double least = 1, most = -1;
    for (std::uint32_t i = 0; i < looks.count; ++i) {
      const regions::Witness pair = looks.pair(i);
      const double x = centre_of(ball().view.region_triangles[pair.b]).x;
      least = std::min(least, x);
      most = std::max(most, x);
    }
    EXPECT_LT(least, -0.7);
    EXPECT_GT(most, 0.7);
  }
}

TEST(RegionLook, Far_outside_something_is_named) {
  const ImageView& view = ball().view;
  regions::PairFrame frame = coincident(view);
  for (const float away : {-1e6f, -3.0f, 3.0f, 1e6f, 1e30f}) {
    std::fill_n(frame.a_to_b.translation, 3, away);
    regions::Looks looks;
    regions::look_over(frame, 0, 0, regions::kMostLooks, looks);
    regions::look_from(kernels(), frame, looks);
    for (std::uint32_t i = 0; i < looks.count; ++i) {
      const regions::Witness pair = looks.pair(i);
      EXPECT_LT(pair.b, view.region_triangles.size());
    }
  }
}

}  // namespace
}  // namespace palpate::test
