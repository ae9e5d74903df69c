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
            "5d626bc8fc013d3a30ce22c1807513b784e28532e5c1afdd03823aa63f94b003");
}

TEST(BakeGolden, Cube_with_a_sheet) {
  EXPECT_EQ(hash_of(tiny_mesh()),
            "419df1dd53292667733f785b00044bc1498e650fd461abfa0e0b37fbb940c56e");
}

}  // namespace
}  // namespace palpate::bake
