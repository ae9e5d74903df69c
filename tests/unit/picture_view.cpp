// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "picture_support.hpp"

namespace palpate::picture::testing {
namespace {

using Face = std::array<std::uint32_t, 3>;

void expect_near(Vec3d a, Vec3d b) { EXPECT_LT(squared_norm(a - b), 1e-24); }

TEST(ViewFrom, The_front_has_x_to_the_right_and_z_up) {
  const View view = view_from({0, -5, 0});
  expect_near(view.toward, {0, -1, 0});
  expect_near(view.right, {1, 0, 0});
  expect_near(view.up, {0, 0, 1});
}

TEST(ViewFrom, Above_and_below_have_y_up) {
  for (const double z : {3.0, -3.0}) {
    const View view = view_from({0, 0, z});
    expect_near(view.up, {0, 1, 0});
    expect_near(view.right, {z > 0 ? 1.0 : -1.0, 0, 0});
  }
}

TEST(ViewFrom, Is_orthonormal_and_right_handed_for_any_length) {
  for (const double length : {1e-300, 1.0, 1e300}) {
    const View view = view_from({length, -2 * length, 1.5 * length});
    expect_near(cross(view.right, view.up), view.toward);
    for (const Vec3d& axis : {view.right, view.up, view.toward}) {
      EXPECT_NEAR(squared_norm(axis), 1, 1e-12);
    }
  }
}

TEST(BoundsOf, Are_the_least_rectangle_of_what_is_seen) {
  const std::vector<Vec3f> points = {{1, 7, -2}, {-3, 0, 4}, {0, 0, 0}};
  const Bounds bounds = bounds_of(view_from({0, -1, 0}), points);
  EXPECT_NEAR(bounds.left, -3, 1e-12);
  EXPECT_NEAR(bounds.right, 1, 1e-12);
  EXPECT_NEAR(bounds.bottom, -2, 1e-12);
  EXPECT_NEAR(bounds.top, 4, 1e-12);
}

// A square 1 wide in the middle of a picture twice as wide as high.
TEST(Draw, Fills_the_height_and_stays_in_the_middle) {
  const std::vector<Vec3f> points = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
  const std::vector<Face> faces = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Rgb> colours = {kRed, kBlue};
  const View view = view_from({0, -1, 0});
  Raster raster(8, 4);
  draw(raster, view, bounds_of(view, points), {points, faces, colours});
  EXPECT_EQ(as_text(raster),
            "..bbbr..\n"
            "..bbrr..\n"
            "..brrr..\n"
            "..rrrr..\n");
}

// The roof x = +-z seen from above: both halves lean by 60 degrees, cos = 1/2.
TEST(Draw, Faces_that_turn_away_are_darker_on_either_side) {
  const float height = 1.7320508f;
  const std::vector<Vec3f> points = {{0, 0, height}, {0, 1, height}, {1, 0, 0}, {-1, 0, 0}};
  const std::vector<Face> faces = {{0, 2, 1}, {0, 3, 1}};  // the second one is seen from behind
  const std::vector<Rgb> colours = {kWhite, kWhite};
  const View view = view_from({0, 0, 1});
  Raster raster(8, 4);
  draw(raster, view, bounds_of(view, points), {points, faces, colours});
  const Rgb half = dimmed(kWhite, 0.3 + 0.7 * 0.5);
  EXPECT_EQ(raster.at(3, 3), half);
  EXPECT_EQ(raster.at(4, 3), half);
  EXPECT_EQ(raster.at(0, 0), kWhite);
}

TEST(Draw, Outlines_large_faces_only) {
  const std::vector<Vec3f> points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  const std::vector<Face> faces = {{0, 1, 2}};
  const std::vector<Rgb> colours = {kRed};
  const View view = view_from({0, -1, 0});
  for (const auto& [size, outlined] : {std::pair{12, false}, std::pair{90, true}}) {
    Raster raster(size, size);
    draw(raster, view, bounds_of(view, points), {points, faces, colours});
    const auto dark = std::count_if(raster.colours.begin(), raster.colours.end(),
                                    [](Rgb c) { return c.r < 200 && c.g == 0; });
    EXPECT_EQ(dark > 0, outlined) << size;
    EXPECT_EQ(raster.at(size / 3, size * 2 / 3), kRed);
  }
}

TEST(Draw, What_has_no_extent_is_no_fault) {
  const std::vector<Vec3f> points = {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}};
  const std::vector<Face> faces = {{0, 1, 2}};
  const std::vector<Rgb> colours = {kRed};
  const View view = view_from({1, 1, 1});
  Raster raster(4, 4);
  draw(raster, view, bounds_of(view, points), {points, faces, colours});
  EXPECT_EQ(std::count(raster.colours.begin(), raster.colours.end(), kWhite), 16);
}

}  // namespace
}  // namespace palpate::picture::testing
