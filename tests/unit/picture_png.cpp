// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <random>
#include <set>

#include "picture_support.hpp"
#include "tools/picture/indexed.hpp"

namespace palpate::picture::testing {
namespace {

Raster decoded(const std::vector<std::byte>& bytes) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&head, bytes.data(), bytes.size()), 0) << head.message;
  head.format = PNG_FORMAT_RGB;
  Raster raster(static_cast<int>(head.width), static_cast<int>(head.height));
  EXPECT_NE(png_image_finish_read(&head, nullptr, raster.colours.data(), 0, nullptr), 0)
      << head.message;
  return raster;
}

Raster noise(int width, int height, unsigned colours) {
  std::mt19937 random(3);
  Raster raster(width, height);
  for (Rgb& c : raster.colours) c = colour_of(static_cast<std::uint32_t>(random()) % colours);
  return raster;
}

int distance(Rgb a, Rgb b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}

TEST(ToPng, Few_colours_come_back_exactly) {
  for (const unsigned colours : {1u, 2u, 3u, 17u, 256u}) {
    const Raster raster = noise(61, 43, colours);
    const Raster back = decoded(to_png(raster));
    EXPECT_EQ(back.width, raster.width);
    EXPECT_EQ(back.colours, raster.colours) << colours;
  }
}

TEST(ToPng, One_pixel_is_a_picture) {
  Raster raster(1, 1);
  raster.at(0, 0) = {1, 2, 3};
  EXPECT_EQ(decoded(to_png(raster)).colours, raster.colours);
}

TEST(ToPng, Many_colours_come_back_nearly) {
  Raster raster(64, 64);  // a slope of 4096 colours
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      raster.at(x, y) = {static_cast<std::uint8_t>(4 * x), static_cast<std::uint8_t>(4 * y), 90};
    }
  }
  const Raster back = decoded(to_png(raster));
  for (std::size_t i = 0; i < raster.colours.size(); ++i) {
    // 256 sets of 16: squares of 4 by 4 steps of 4, at most 8 off in each channel; some are oblong.
    EXPECT_LE(distance(raster.colours[i], back.colours[i]), 24) << i;
  }
}

TEST(Indexed, Means_are_weighted_by_pixels) {
  Raster raster(300, 4);
  for (int x = 0; x < 300; ++x) {
    for (int y = 0; y < 4; ++y) raster.at(x, y) = {static_cast<std::uint8_t>(x % 256), 0, 0};
  }
  // One colour more than the palette holds: two neighbours share an entry.
  for (int y = 0; y < 4; ++y) raster.at(299, y) = {0, 255, 0};
  const Indexed picture = indexed(raster);
  EXPECT_EQ(picture.palette.size(), kMaxPalette);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < raster.colours.size(); ++i) {
    const int off = distance(raster.colours[i], picture.palette[picture.indices[i]]);
    EXPECT_LE(off, 1);
    changed += off > 0 ? 1 : 0;
  }
  EXPECT_LE(changed, 8u);
}

TEST(Indexed, Is_the_same_each_time) {
  const Raster raster = noise(80, 80, 5000);
  const Indexed one = indexed(raster), other = indexed(raster);
  EXPECT_EQ(one.indices, other.indices);
  EXPECT_EQ(one.palette, other.palette);
}

}  // namespace
}  // namespace palpate::picture::testing
