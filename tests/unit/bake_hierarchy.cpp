// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "bake_support.hpp"
#include "host_bake/hierarchy/dop.hpp"
#include "host_bake/hierarchy/merge.hpp"
#include "host_bake/hierarchy/pairing.hpp"

namespace palpate::bake {
namespace {

using testing::triangle_tree;

Dop point_dop(float x, float y, float z) {
  const PointF p{x, y, z};
  return dop_of(std::span(&p, 1));
}

std::vector<Dop> random_dops(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> at(-0.5f, 0.5f);
  std::vector<Dop> dops;
  dops.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    dops.push_back(point_dop(at(random), at(random), at(random)));
  }
  return dops;
}

TEST(Dop, Unit_cube_has_its_widths) {
  std::vector<PointF> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i) {
    corners.push_back(
        {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
  }
  const double wanted = (3 * 1 + 6 * std::sqrt(2.0) + 4 * std::sqrt(3.0)) / 13;
  EXPECT_NEAR(mean_width(dop_of(corners)), wanted, 1e-12);
}

TEST(Dop, United_is_the_dop_of_all_points) {
  const std::vector<PointF> points{{0, 0, 0}, {1, 2, 3}, {-1, 0.5f, 2}, {4, -3, 1}};
  const Dop whole = dop_of(points);
  const Dop parts = united(dop_of(std::span(points).first(2)), dop_of(std::span(points).last(2)));
  EXPECT_EQ(whole.low, parts.low);
  EXPECT_EQ(whole.high, parts.high);
}

Dop box_dop(float x, float size) {
  return dop_of(std::vector<PointF>{{x, 0, 0}, {x + size, size, size}});
}

TEST(PairUp, Near_ones_are_paired) {
  const std::vector<Dop> line{box_dop(0, 0.1f), box_dop(0.5f, 0.1f), box_dop(0.6f, 0.1f),
                              box_dop(0.1f, 0.1f)};
  EXPECT_EQ(pair_up(line, {}), (std::vector<PiecePair>{{0, 3}, {1, 2}}));
}

TEST(PairUp, Pair_far_apart_waits) {
  const std::vector<Dop> line{box_dop(-0.9f, 0.1f), box_dop(0, 0.1f), box_dop(0.1f, 0.1f),
                              box_dop(0.8f, 0.1f)};
  EXPECT_EQ(pair_up(line, {}), (std::vector<PiecePair>{{1, 2}}));
}

TEST(PairUp, One_or_none_has_no_pair) {
  EXPECT_TRUE(pair_up({}, {}).empty());
  EXPECT_TRUE(pair_up(random_dops(1, 1), {}).empty());
}

TEST(PairUp, Ties_go_to_the_lower_index) {
  const std::vector<Dop> equal(5, point_dop(0, 0, 0));
  EXPECT_EQ(pair_up(equal, {}), (std::vector<PiecePair>{{0, 1}, {2, 3}}));
}

// Points never meet, so that every pair is a loose one: the hardest case for progress.
TEST(PairUp, Any_set_is_matched_at_least_to_a_quarter) {
  for (const std::size_t count : {2u, 3u, 7u, 199u, 200u, 201u, 5000u}) {
    const auto pairs = pair_up(random_dops(count, count), {});
    EXPECT_GE(4 * pairs.size(), count) << count;
    std::set<std::uint32_t> used;
    for (const auto& [a, b] : pairs) {
      EXPECT_LT(a, b);
      EXPECT_LT(b, count);
      EXPECT_TRUE(used.insert(a).second && used.insert(b).second) << a << " " << b;
    }
    EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  }
}

TEST(Neighbours, Cube_triangles_meet_in_18_edges) {
  const Hierarchy tree = triangle_tree(testing::cube());
  EXPECT_EQ(edge_neighbours(tree, top_pieces(tree)).size(), 18u);
}

// Whatever the mesh: one root, every level's count true, no piece alone under a parent.
void expect_sound_tree(const Hierarchy& tree, std::size_t leaves, std::size_t most_children = 2) {
  ASSERT_EQ(tree.levels[0].pieces, leaves);
  if (most_children == 2) {
    ASSERT_EQ(tree.pieces.size(), 2 * leaves - 1);
  }
  EXPECT_EQ(top_pieces(tree),
            std::vector<std::uint32_t>{static_cast<std::uint32_t>(tree.pieces.size() - 1)});
  std::vector<std::uint32_t> alive(tree.levels.size(), 0);
  for (std::uint32_t i = 0; i < tree.pieces.size(); ++i) {
    const TreePiece& piece = tree.pieces[i];
    EXPECT_GE(piece.children.size(), piece.level == 0 ? 0u : 2u);
    EXPECT_LE(piece.children.size(), piece.level == 0 ? 0u : most_children);
    for (const std::uint32_t c : piece.children) {
      EXPECT_LT(c, i);
      EXPECT_EQ(tree.pieces[c].parent, i);
      EXPECT_LT(tree.pieces[c].level, piece.level);
    }
    const std::size_t end =
        piece.parent == image::kNone ? tree.levels.size() : tree.pieces[piece.parent].level;
    for (std::size_t l = piece.level; l < end; ++l) ++alive[l];
  }
  for (std::size_t l = 0; l < tree.levels.size(); ++l) {
    EXPECT_EQ(alive[l], tree.levels[l].pieces);
    EXPECT_EQ(tree.levels[l].free, l > 0);
  }
}

TEST(MergeToRoot, Meshes_of_all_kinds_end_in_one_root) {
  const std::vector<Mesh> meshes{testing::cube(), testing::sphere(), testing::sheet(7),
                                 testing::two_spheres(20), testing::dented_sphere()};
  for (const Mesh& mesh : meshes) {
    Hierarchy tree = triangle_tree(mesh);
    merge_to_root(tree, {});
    expect_sound_tree(tree, mesh.faces.size());
  }
}

TEST(MergeToRoot, More_rounds_make_fewer_levels_of_the_same_root) {
  for (const Mesh& mesh : {testing::dented_sphere(), testing::two_spheres(20)}) {
    Hierarchy pairs = triangle_tree(mesh);
    Hierarchy wide = pairs;
    merge_to_root(pairs, {});
    merge_to_root(wide, {}, 4);
    expect_sound_tree(wide, mesh.faces.size(), 16);
    EXPECT_LE(4 * (wide.levels.size() - 1), pairs.levels.size() - 1 + 3);
    EXPECT_LT(wide.pieces.size(), 1.15 * static_cast<double>(mesh.faces.size()));
    EXPECT_EQ(wide.pieces.back().vertices, pairs.pieces.back().vertices);
  }
}

TEST(MergeToRoot, Single_piece_is_the_root_already) {
  Hierarchy tree = triangle_tree({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  merge_to_root(tree, {});
  expect_sound_tree(tree, 1);
  EXPECT_EQ(tree.levels.size(), 1u);
}

TEST(MergeToRoot, Root_hull_is_that_of_the_mesh) {
  Hierarchy tree = triangle_tree(testing::dented_sphere());
  merge_to_root(tree, {});
  std::vector<std::uint32_t> extreme = convex_hull(tree.points).vertices;
  EXPECT_EQ(tree.pieces.back().vertices, extreme);
}

TEST(MergeToRoot, Components_far_apart_meet_last) {
  const Mesh mesh = testing::two_spheres(20);
  Hierarchy tree = triangle_tree(mesh);
  merge_to_root(tree, {});
  const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
  std::set<std::uint32_t> of_first, of_second;  // children of the root over each sphere
  for (std::uint32_t leaf = 0; leaf < faces; ++leaf) {
    std::uint32_t top = leaf;
    while (tree.pieces[top].parent + 1 != tree.pieces.size()) top = tree.pieces[top].parent;
    (leaf < faces / 2 ? of_first : of_second).insert(top);
  }
  EXPECT_EQ(of_first.size(), 1u);
  EXPECT_EQ(of_second.size(), 1u);
}

double sum_of_widths(const Hierarchy& tree) {
  double sum = 0;
  for (const TreePiece& piece : tree.pieces) sum += mean_width(dop_of(hull_points(tree, piece)));
  return sum;
}

TEST(MergeToRoot, Hulls_are_tighter_than_by_index_order) {
  Hierarchy tree = triangle_tree(testing::dented_sphere(4));
  Hierarchy by_index = tree;
  merge_to_root(tree, {});
  // Pairs of successive pieces, bounded by the union of their points.
  std::vector<Dop> front;
  for (const TreePiece& piece : by_index.pieces)
    front.push_back(dop_of(hull_points(by_index, piece)));
  double index_sum = 0;
  while (true) {
    for (const Dop& dop : front) index_sum += mean_width(dop);
    if (front.size() == 1) break;
    std::vector<Dop> next;
    for (std::size_t i = 0; i + 1 < front.size(); i += 2)
      next.push_back(united(front[i], front[i + 1]));
    if (front.size() % 2 == 1) next.push_back(front.back());
    front = next;
  }
  EXPECT_LT(sum_of_widths(tree), 0.98 * index_sum);
}

}  // namespace
}  // namespace palpate::bake
