// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/text.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "picture_support.hpp"

namespace palpate::picture::testing {
namespace {

TEST(DrawText, Letters_stand_on_one_line) {
  Raster raster(18, 9);
  draw_text(raster, 0, 0, 1, "1p,");
  EXPECT_EQ(as_text(raster),
            "..k...............\n"
            ".kk...............\n"
            "..k...kkkk........\n"
            "..k...k...k.......\n"
            "..k...k...k.......\n"
            "..k...k...k...k...\n"
            ".kkk..kkkk....k...\n"
            "......k......k....\n"
            "......k...........\n");
}

TEST(DrawText, Scale_makes_each_dot_a_square) {
  Raster raster(12, 18);
  draw_text(raster, 0, 0, 2, ".");
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 12; ++x) {
      const bool black = x / 2 == 2 && (y / 2 == 5 || y / 2 == 6);
      EXPECT_EQ(raster.at(x, y), black ? kBlack : kWhite) << x << ", " << y;
    }
  }
}

TEST(DrawText, Every_letter_has_a_shape_of_its_own) {
  std::set<std::string> shapes;
  const std::string letters = "abcdefghijklmnopqrstuvwxyz0123456789., ";
  for (const char letter : letters) {
    Raster raster(kLetterWidth, kLetterHeight);
    draw_text(raster, 0, 0, 1, {&letter, 1});
    for (int y = 0; y < kLetterHeight; ++y) EXPECT_EQ(raster.at(kLetterWidth - 1, y), kWhite);
    shapes.insert(as_text(raster));
  }
  EXPECT_EQ(shapes.size(), letters.size());
}

TEST(DrawText, Unknown_letters_are_gaps_and_what_is_outside_is_cut_off) {
  Raster raster(4, 4);
  draw_text(raster, 0, 0, 1, "%\xff");
  EXPECT_EQ(as_text(raster), "....\n....\n....\n....\n");
  draw_text(raster, -2, -3, 1, "l");
  EXPECT_EQ(as_text(raster), "k...\nk...\nk...\nkk..\n");
}

}  // namespace
}  // namespace palpate::picture::testing
