// SPDX-License-Identifier: GPL-3.0-or-later
// The image of a tiny mesh, byte for byte: it may change only on purpose, together with what
// docs/FORMAT.md says or with what the baker does.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "../unit/bake_support.hpp"

namespace palpate::bake {
namespace {

std::string hash_of(const Mesh& mesh) {
  const testing::Image image(testing::bake_bytes(mesh, 1));
  std::string text;
  for (const std::uint8_t byte : image.view.header->content_sha256) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

// A cube and a notched block beside it. All coordinates are small integers.
Mesh tiny_mesh() {
  Mesh mesh = testing::together(testing::cube({0, 0, 0}, 2), testing::sheet(2));
  mesh.points[1][0] = 1;  // a corner pushed in: reflex edges
  return mesh;
}

TEST(BakeGolden, Triangle) {
  EXPECT_EQ(hash_of({{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}}),
            "5fcf9460e040d4e65b9ad94a0a165193f3fbe9aed52c3e98ccb6b767690019eb");
}

TEST(BakeGolden, Cube_with_a_sheet) {
  EXPECT_EQ(hash_of(tiny_mesh()),
            "852cd454b2de518cf0f81e5e2c7f411977d794e6bb21634c700210110d1c3a3a");
}

}  // namespace
}  // namespace palpate::bake
