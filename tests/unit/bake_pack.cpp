// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "bake_support.hpp"
#include "host_bake/hierarchy/merge.hpp"
#include "host_bake/metrics/metrics.hpp"
#include "host_bake/pack/adjacency.hpp"
#include "host_bake/pack/pack.hpp"

namespace palpate::bake {
namespace {

using testing::bake_bytes;
using testing::Image;

const Mesh kTriangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};

std::string refusal_of(const Mesh& mesh, const BakeOptions& options) {
  BakeReport report;
  try {
    bake(mesh, check(mesh), options, {}, report);
  } catch (const InputRefused& e) {
    return e.what();
  }
  return {};
}

TEST(Adjacency, Tetrahedron_joins_all) {
  const std::vector<std::array<std::uint32_t, 3>> faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const Adjacency joined = adjacency(faces, 4);
  EXPECT_EQ(joined.starts, (std::vector<std::uint32_t>{0, 3, 6, 9, 12}));
  EXPECT_EQ(joined.neighbours, (std::vector<std::uint32_t>{1, 2, 3, 0, 2, 3, 0, 1, 3, 0, 1, 2}));
}

TEST(Bake, Single_triangle_is_an_image_of_one_piece) {
  const Image image(bake_bytes(kTriangle));
  ASSERT_EQ(image.view.pieces.size(), 1u);
  EXPECT_EQ(image.view.levels.size(), 1u);
  EXPECT_EQ(image.view.header->free_levels, 0u);
  EXPECT_EQ(image.view.pieces[0].flags & static_cast<std::uint32_t>(image::PieceFlag::all_real),
            static_cast<std::uint32_t>(image::PieceFlag::all_real));
}

TEST(Bake, Convex_body_is_one_piece_with_neighbour_lists) {
  const Image image(bake_bytes(testing::sphere({0, 0, 0}, 1, 2)));
  ASSERT_EQ(image.view.pieces.size(), 1u);
  EXPECT_GT(image.view.pieces[0].hull_vertices, image::kAdjacencyAbove);
  EXPECT_EQ(image.view.neighbour_starts.size(), image.view.pieces[0].hull_vertices + 1u);
  EXPECT_EQ(image.view.virtual_faces.size(), 0u);
}

TEST(Bake, Header_tells_of_the_source) {
  const Mesh mesh = testing::together(testing::sheet(3), testing::cube({5, 0, 0}, 2));
  BakeReport report;
  BakeOptions options;
  options.repaired = true;
  options.delta_rel = 0.25;
  options.source_sha256.fill(0xab);
  const Image image(bake(mesh, check(mesh), options, {}, report));
  const image::Header& h = *image.view.header;
  EXPECT_EQ(h.source_triangles, mesh.faces.size());
  EXPECT_EQ(h.source_vertices, mesh.points.size());
  EXPECT_EQ(h.source_components, 2u);
  EXPECT_EQ(h.source_boundary_edges, 12u);
  EXPECT_EQ(h.flags, static_cast<std::uint32_t>(image::HeaderFlag::repaired) |
                         static_cast<std::uint32_t>(image::HeaderFlag::open));
  EXPECT_EQ(h.delta_rel, 0.25f);
  EXPECT_EQ(h.source_sha256[31], 0xab);
  EXPECT_EQ(h.tree_depth, static_cast<std::uint32_t>(image.view.levels.size()));
}

TEST(Bake, Positions_come_back_in_metres) {
  const Mesh mesh = testing::cube({10, 20, 30}, 0.5);
  const Image image(bake_bytes(mesh));
  const image::Header& h = *image.view.header;
  for (const image::Vertex& v : image.view.vertices) {
    double nearest = 1;
    for (const Point& p : mesh.points) {
      double far = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        far = std::max(
            far, std::abs(h.centre_m[i] + h.radius_m * static_cast<double>(v.position[i]) - p[i]));
      }
      nearest = std::min(nearest, far);
    }
    EXPECT_LT(nearest, 1e-7 * h.radius_m);
  }
}

TEST(Bake, Same_bytes_on_one_and_two_threads) {
  for (const Mesh& mesh : {testing::dented_sphere(), testing::two_spheres(), testing::sheet(9)}) {
    EXPECT_EQ(bake_bytes(mesh, 1), bake_bytes(mesh, 2));
  }
}

TEST(Bake, Report_has_stages_and_memory) {
  BakeReport report;
  BakeOptions options;
  options.threads = 2;
  const Mesh mesh = testing::dented_sphere();
  std::set<std::string> seen;
  double last = 0;
  bake(
      mesh, check(mesh), options,
      [&](std::string_view stage, double done) {
        seen.emplace(stage);
        EXPECT_GE(done, last - 0.05) << stage;  // it may think again, but never begins anew
        last = std::max(last, done);
        EXPECT_GE(done, 0);
        EXPECT_LE(done, 1);
      },
      report);
  for (const char* stage : {"normalise", "decompose", "merge", "metrics", "pack", "validate"}) {
    EXPECT_EQ(report.seconds.count(stage), 1u) << stage;
  }
  EXPECT_TRUE(seen.count("merge") == 1 && seen.count("metrics") == 1 && seen.count("pack") == 1);
  EXPECT_EQ(last, 1);
  EXPECT_GT(report.peak_bytes, 1u << 20);
  EXPECT_EQ(report.threads, 2u);
}

TEST(Bake, What_the_format_cannot_hold_is_refused_by_name) {
  BakeOptions options;
  options.delta_rel = 0;
  EXPECT_NE(refusal_of(kTriangle, options).find("delta"), std::string::npos);
  options.delta_rel = 0.01;
  Mesh tiny = kTriangle, huge = kTriangle;
  for (Point& p : tiny.points) p[0] *= 1e-14, p[1] *= 1e-14;
  for (Point& p : huge.points) p[0] *= 1e14, p[1] *= 1e14;
  EXPECT_NE(refusal_of(tiny, options).find("size"), std::string::npos) << refusal_of(tiny, options);
  EXPECT_NE(refusal_of(huge, options).find("size"), std::string::npos) << refusal_of(huge, options);
}

TEST(Pack, Too_many_children_are_refused_by_name) {
  Hierarchy tree = testing::triangle_tree(testing::sheet(46));
  ASSERT_GT(tree.pieces.size(), image::kMaxChildren);
  TreePiece root;
  root.level = 1;
  for (std::uint32_t i = 0; i < tree.pieces.size(); ++i) {
    root.children.push_back(i);
    tree.pieces[i].parent = static_cast<std::uint32_t>(tree.pieces.size());
  }
  root.vertices = {0, 1, 2};
  root.hull_vertices = 3;
  tree.pieces.push_back(root);
  tree.levels.push_back({.pieces = 1, .free = true});
  Metrics metrics;
  metrics.spheres.resize(tree.pieces.size());
  metrics.surface_deviation.resize(tree.pieces.size());
  metrics.hausdorff.resize(tree.pieces.size());
  metrics.culling.resize(tree.pieces.size());
  metrics.support_area.resize(tree.points.size(), 1);
  try {
    pack(tree, metrics, {});
    FAIL();
  } catch (const InputRefused& e) {
    EXPECT_NE(std::string(e.what()).find("children"), std::string::npos) << e.what();
  }
}

TEST(Pack, Levels_of_several_children_are_laid_out) {
  // As simplified levels are: four triangles under one parent.
  const NormalMesh mesh = normalise(testing::sheet(2));
  Hierarchy tree = level_zero(mesh, testing::triangle_patches(mesh), 3);
  const auto first = static_cast<std::uint32_t>(tree.pieces.size());
  for (std::uint32_t half = 0; half < 2; ++half) {
    TreePiece parent;
    parent.level = 1;
    parent.children = {4 * half, 4 * half + 1, 4 * half + 2, 4 * half + 3};
    for (const std::uint32_t c : parent.children) tree.pieces[c].parent = first + half;
    parent.vertices = tree.pieces[4 * half].vertices;
    parent.hull_vertices = 3;
    parent.dimension = 2;
    parent.hull_faces = tree.pieces[4 * half].hull_faces;
    parent.triangles = {{{0, 1, 2}, image::kNone}};
    parent.all_real = true;
    parent.enclosing = enclosing_hull(tree, parent.children).points;
    tree.pieces.push_back(parent);
  }
  tree.levels.push_back({.pieces = 2, .triangles = 2, .free = false, .resolution = 2});
  merge_to_root(tree, {});
  image::Header facts{};
  facts.radius_m = 1;
  facts.source_triangles = 8;
  facts.source_vertices = 9;
  facts.source_components = 1;
  facts.source_boundary_edges = 8;
  facts.flags = static_cast<std::uint32_t>(image::HeaderFlag::open);
  facts.delta_rel = 0.01f;
  const Metrics metrics =
      measure(tree, {}, {{0.1f, 0.1f}}, std::vector<float>(tree.points.size(), 1), {});
  const Image image(pack(tree, metrics, facts));
  ASSERT_EQ(image.view.levels.size(), 3u);
  EXPECT_EQ(image.view.header->max_children, 4u);
  EXPECT_EQ(image.view.header->free_levels, 1u);
  EXPECT_EQ(image.view.levels[1].max_surface_deviation_rel, 0.1f);
  EXPECT_GT(image.view.levels[1].max_hausdorff_rel, 0.1f);
}

}  // namespace
}  // namespace palpate::bake
