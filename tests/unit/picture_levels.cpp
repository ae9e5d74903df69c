// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "../support/tiny_image.hpp"
#include "tools/palpate/level_mesh.hpp"
#include "tools/palpate/level_picture.hpp"

namespace palpate::cli {
namespace {

using Levels = std::vector<std::uint32_t>;

Levels shown(std::size_t levels, std::uint32_t free_levels) {
  const std::vector<image::Level> rows(levels);
  image::Header header{};
  header.free_levels = free_levels;
  ImageView image;
  image.header = &header;
  image.levels = rows;
  return shown_levels(image);
}

TEST(ShownLevels, Are_the_original_three_simplified_and_two_free) {
  EXPECT_EQ(shown(16, 8), (Levels{0, 2, 5, 7, 11, 15}));
  EXPECT_EQ(shown(18, 2), (Levels{0, 5, 10, 15, 16, 17}));
}

TEST(ShownLevels, Of_small_images_are_shown_once) {
  EXPECT_EQ(shown(1, 0), (Levels{0}));
  EXPECT_EQ(shown(2, 1), (Levels{0, 1}));
  EXPECT_EQ(shown(2, 0), (Levels{0, 1}));
  for (std::size_t levels = 1; levels < 20; ++levels) {
    for (std::uint32_t free_levels = 0; free_levels < levels; ++free_levels) {
      const Levels list = shown(levels, free_levels);
      EXPECT_EQ(list.front(), 0u);
      EXPECT_EQ(list.back(), levels - 1);
      EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
      EXPECT_EQ(std::set(list.begin(), list.end()).size(), list.size());
    }
  }
}

/// Two boxes side by side under one root.
class LevelsOfBoxes : public testing::Test {
 protected:
  LevelsOfBoxes()
      : bytes_(seal(test::parts_of({test::box_part({-0.25f, 0, 0}, {0.25f, 0.125f, 0.125f}),
                                    test::box_part({0.25f, 0, 0}, {0.25f, 0.125f, 0.125f})}))) {
    EXPECT_EQ(validate(bytes_, image_), Status::ok);
  }

  test::AlignedBytes bytes_;
  ImageView image_;
};

TEST_F(LevelsOfBoxes, LevelMesh_has_patches_below_and_hulls_above) {
  const LevelMesh patches = level_mesh(image_, 0), hull = level_mesh(image_, 1);
  EXPECT_EQ(patches.points.size(), 16u);
  EXPECT_EQ(patches.faces.size(), 24u);
  EXPECT_EQ(std::set(patches.piece_of_point.begin(), patches.piece_of_point.end()).size(), 2u);
  EXPECT_EQ(hull.points.size(), 8u);
  EXPECT_EQ(hull.faces.size(), 12u);
}

TEST_F(LevelsOfBoxes, LevelPicture_shows_the_original_plain_and_the_root_in_its_colour) {
  const picture::Raster sheet = level_picture(image_, {0, 1}, {0, -1, 0});
  // Two panels of one row; the boxes' front is a face across the middle of each.
  const int y = 10 + 45;
  const picture::Rgb original = sheet.at(10 + 70, y), root = sheet.at(10 + 290 + 70, y);
  EXPECT_EQ(original.r, original.g);
  EXPECT_EQ(root, picture::colour_of(0));
  EXPECT_EQ(sheet.at(0, 0), picture::kWhite);
}

TEST_F(LevelsOfBoxes, LevelPicture_is_the_same_each_time) {
  const Levels levels = shown_levels(image_);
  EXPECT_EQ(level_picture(image_, levels, {1, -2, 1}).colours,
            level_picture(image_, levels, {1, -2, 1}).colours);
}

}  // namespace
}  // namespace palpate::cli
