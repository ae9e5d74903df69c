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
            "c34b8ea00899eddf073875afcd2dd7ae3e8b4d091ac6d9829873eaf3a468f690");
}

TEST(BakeGolden, Cube_with_a_sheet) {
  EXPECT_EQ(hash_of(tiny_mesh()),
            "be4acf095e737b9d4c8645b086ac468ea447f6d920f32d6e54897b1374f861cb");
}

}  // namespace
}  // namespace palpate::bake
