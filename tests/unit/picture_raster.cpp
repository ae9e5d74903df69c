// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/raster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "picture_support.hpp"

namespace palpate::picture::testing {
namespace {

using Corners = std::array<Corner, 3>;

TEST(FillTriangle, Right_angle_covers_the_centres_on_and_inside_its_border) {
  Raster raster(5, 4);
  // The hypotenuse x + y = 4 runs through the centres of the diagonal.
  fill_triangle(raster, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {kRed, kRed, 0});
  EXPECT_EQ(as_text(raster),
            "rrrr.\n"
            "rrr..\n"
            "rr...\n"
            "r....\n");
}

TEST(FillTriangle, Either_way_round_covers_the_same) {
  Raster one(9, 9), other(9, 9);
  const Corners corners = {{{0.3, 1.1, 0}, {8.6, 2.9, 0}, {3.3, 8.2, 0}}};
  fill_triangle(one, corners, {kRed, kRed, 0});
  fill_triangle(other, {corners[2], corners[1], corners[0]}, {kRed, kRed, 0});
  EXPECT_EQ(as_text(one), as_text(other));
  EXPECT_EQ(one.nearness, other.nearness);
}

TEST(FillTriangle, Nearer_hides_farther_in_any_order) {
  const Corners far = {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}};
  const Corners near = {{{0, 0, 2}, {2, 0, 2}, {0, 2, 2}}};
  for (const bool near_first : {false, true}) {
    Raster raster(4, 3);
    fill_triangle(raster, near_first ? near : far, {near_first ? kGreen : kRed, kBlack, 0});
    fill_triangle(raster, near_first ? far : near, {near_first ? kRed : kGreen, kBlack, 0});
    EXPECT_EQ(as_text(raster),
              "ggrr\n"
              "grr.\n"
              "rr..\n");
  }
}

TEST(FillTriangle, Crossing_triangles_hide_each_other_where_they_are_farther) {
  Raster raster(4, 1);
  fill_triangle(raster, {{{0, -9, 0}, {0, 9, 0}, {8, 0, 8}}}, {kRed, kRed, 0});
  fill_triangle(raster, {{{4, -9, 0}, {4, 9, 0}, {-4, 0, 8}}}, {kGreen, kGreen, 0});
  // Nearness x of the one against 4 - x of the other.
  EXPECT_EQ(as_text(raster), "ggrr\n");
}

TEST(FillTriangle, Ties_leave_the_first) {
  Raster raster(2, 1);
  const Corners corners = {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}};
  fill_triangle(raster, corners, {kRed, kRed, 0});
  fill_triangle(raster, corners, {kGreen, kGreen, 0});
  EXPECT_EQ(as_text(raster), "rr\n");
}

TEST(FillTriangle, Edges_are_as_wide_as_asked) {
  Raster raster(9, 5);
  // The right edge x = 9 - y / 10 is less than a pixel from the last column's centres only.
  fill_triangle(raster, {{{0, 0, 0}, {9, 0, 0}, {0, 90, 0}}}, {kGreen, kBlack, 1});
  EXPECT_EQ(as_text(raster),
            "kkkkkkkkk\n"
            "kgggggggk\n"
            "kgggggggk\n"
            "kgggggggk\n"
            "kgggggggk\n");
}

TEST(FillTriangle, What_is_outside_is_cut_off) {
  Raster raster(3, 2);
  fill_triangle(raster, {{{-1e6, -1e6, 0}, {1e6, -1e6, 0}, {0, 1e6, 0}}}, {kRed, kRed, 0});
  EXPECT_EQ(as_text(raster), "rrr\nrrr\n");
  Raster empty(3, 2);
  fill_triangle(empty, {{{-9, 0, 0}, {-1, 0, 0}, {-1, 2, 0}}}, {kRed, kRed, 0});
  fill_triangle(empty, {{{9, 9, 0}, {12, 9, 0}, {12, 12, 0}}}, {kRed, kRed, 0});
  EXPECT_EQ(as_text(empty), "...\n...\n");
}

TEST(FillTriangle, Without_area_covers_nothing) {
  Raster raster(3, 3);
  fill_triangle(raster, {{{0, 0, 0}, {1.5, 1.5, 0}, {3, 3, 0}}}, {kRed, kRed, 1});
  fill_triangle(raster, {{{1.5, 1.5, 0}, {1.5, 1.5, 0}, {1.5, 1.5, 0}}}, {kRed, kRed, 1});
  EXPECT_EQ(as_text(raster), "...\n...\n...\n");
}

// Neighbours that share edges leave no gap, however thin they are.
TEST(FillTriangle, Fans_about_random_points_cover_the_square) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, 20);
  for (int round = 0; round < 200; ++round) {
    const Corner centre{place(random), place(random), 0};
    const std::array<Corner, 5> around = {
        {{0, 0, 0}, {20, 0, 0}, {20, place(random), 0}, {20, 20, 0}, {0, 20, 0}}};
    Raster raster(20, 20);
    for (std::size_t i = 0; i < around.size(); ++i) {
      fill_triangle(raster, {centre, around[i], around[(i + 1) % around.size()]}, {kRed, kRed, 0});
    }
    EXPECT_EQ(std::count(raster.colours.begin(), raster.colours.end(), kRed), 400) << round;
  }
}

TEST(Shrink, Pixels_are_rounded_means_and_the_rest_is_cut_off) {
  Raster raster(5, 2);
  for (int y = 0; y < 2; ++y) raster.at(0, y) = raster.at(1, y) = kRed;
  raster.at(2, 0) = {254, 255, 255};
  raster.at(3, 0) = {0, 1, 2};
  const Raster small = shrink(raster, 2);
  ASSERT_EQ(small.width, 2);
  ASSERT_EQ(small.height, 1);
  EXPECT_EQ(small.at(0, 0), kRed);
  EXPECT_EQ(small.at(1, 0), (Rgb{191, 192, 192}));  // 764 / 4, 766 / 4, 767 / 4
}

TEST(Paste, Copies_to_the_place) {
  Raster raster(4, 3), piece(2, 1);
  piece.at(0, 0) = kRed;
  piece.at(1, 0) = kBlue;
  paste(raster, piece, 2, 1);
  EXPECT_EQ(as_text(raster),
            "....\n"
            "..rb\n"
            "....\n");
}

}  // namespace
}  // namespace palpate::picture::testing
