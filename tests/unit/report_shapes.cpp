// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_shapes.hpp"

#include <gtest/gtest.h>

#include <set>

#include "host_bake/models/models.hpp"
#include "tests/support/baked_scene.hpp"
#include "tools/palpate/level_mesh.hpp"

namespace palpate::cli {
namespace {

const test::BakedBody& body() {
  static const test::BakedBody baked(bake::make_model("golf_ball", 800, 1));
  return baked;
}

TEST(ReportShapes, shape_is_the_finest_level_that_fits) {
  const ImageView& image = body().view;
  EXPECT_EQ(shape_of(image).level, 0u);
  const std::uint32_t most = image.levels[1].triangles;
  const Shape shape = shape_of(image, most);
  EXPECT_EQ(image.levels[shape.level].triangles, shape.faces.size());
  EXPECT_LE(shape.faces.size(), most);
  for (std::uint32_t finer = 0; finer < shape.level; ++finer) {
    EXPECT_GT(image.levels[finer].triangles, most);
  }
}

TEST(ReportShapes, level_that_is_not_free_is_shown_where_none_fits) {
  ASSERT_EQ(body().view.levels.back().free, 1u);
  const Shape shape = shape_of(body().view, 1);
  EXPECT_EQ(body().view.levels[shape.level].free, 0u);
  EXPECT_EQ(body().view.levels[shape.level + 1].free, 1u);
}

TEST(ReportShapes, welded_surface_is_the_same_triangles_with_shared_vertices) {
  const Shape shape = shape_of(body().view);
  const LevelMesh whole = level_mesh(body().view, 0);
  ASSERT_EQ(shape.faces.size(), whole.faces.size());
  for (std::size_t f = 0; f < whole.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(shape.points[shape.faces[f][k]], whole.points[whole.faces[f][k]]);
    }
  }
  // Euler's formula for a closed surface without holes.
  EXPECT_EQ(2 * shape.points.size(), shape.faces.size() + 4);
}

TEST(ReportShapes, pieces_are_their_patches_and_often_shown_ones_come_first) {
  const ImageView& image = body().view;
  const PieceShapes shapes = piece_shapes(image, {{3, 1}, {0, 5}, {7, 2}});
  EXPECT_EQ(shapes.pieces, (std::vector<std::uint32_t>{0, 7, 3}));
  ASSERT_EQ(shapes.starts.size(), 4u);
  EXPECT_EQ(shapes.corners.size(), 3u * shapes.starts.back());
  for (const std::uint32_t piece : shapes.pieces) {
    const std::uint32_t place = shapes.place.at(piece);
    EXPECT_EQ(shapes.starts[place + 1] - shapes.starts[place],
              piece_mesh(image, piece).faces.size());
  }
}

TEST(ReportShapes, pieces_beyond_the_limit_are_left_out) {
  const ImageView& image = body().view;
  std::map<std::uint32_t, std::uint32_t> all;
  for (std::uint32_t i = 0; i < image.pieces.size(); ++i) all[i] = 1;
  const PieceShapes shapes = piece_shapes(image, all, 50);
  EXPECT_LE(shapes.corners.size(), 150u);
  EXPECT_LT(shapes.pieces.size(), all.size());
  EXPECT_EQ(shapes.place.size(), shapes.pieces.size());
}

}  // namespace
}  // namespace palpate::cli
