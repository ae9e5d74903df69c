// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/test_tree.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace palpate::levels {
namespace {

struct Pool {
  explicit Pool(std::size_t n) : nodes(n), slots(n) {
    tree.attach(nodes, slots);
    tree.clear();
  }
  std::vector<Node> nodes;
  std::vector<std::uint32_t> slots;
  TestTree tree;
};

TEST(TestTree, new_root_is_the_whole_front) {
  Pool p(8);
  const std::uint32_t root = p.tree.add_root(3, 10, 20);
  ASSERT_NE(root, kNone);
  ASSERT_EQ(p.tree.front().size(), 1u);
  EXPECT_EQ(p.tree.front()[0], root);
  EXPECT_EQ(p.tree[root].pair, 3);
  EXPECT_EQ(p.tree[root].piece_a, 10u);
  EXPECT_EQ(p.tree[root].piece_b, 20u);
}

TEST(TestTree, split_replaces_a_node_by_all_children_of_one_piece) {
  Pool p(8);
  const std::uint32_t root = p.tree.add_root(0, 1, 2);
  ASSERT_TRUE(p.tree.split(root, false, 30, 3));
  EXPECT_FALSE(p.tree.in_front(root));
  std::set<std::uint32_t> pieces;
  for (const std::uint32_t n : p.tree.front()) {
    EXPECT_EQ(p.tree[n].piece_a, 1u);
    EXPECT_EQ(p.tree[n].parent, root);
    pieces.insert(p.tree[n].piece_b);
  }
  EXPECT_EQ(pieces, (std::set<std::uint32_t>{30, 31, 32}));
}

TEST(TestTree, split_without_room_changes_nothing) {
  Pool p(3);
  const std::uint32_t root = p.tree.add_root(0, 1, 2);
  EXPECT_FALSE(p.tree.split(root, true, 5, 3));
  EXPECT_TRUE(p.tree.in_front(root));
  EXPECT_EQ(p.tree.front().size(), 1u);
  EXPECT_EQ(p.tree.free_nodes(), 2u);
  EXPECT_TRUE(p.tree.split(root, true, 5, 2));
}

TEST(TestTree, empty_pool_gives_no_root) {
  Pool p(1);
  EXPECT_NE(p.tree.add_root(0, 0, 0), kNone);
  EXPECT_EQ(p.tree.add_root(1, 0, 0), kNone);
}

// Every root-to-leaf path crosses the front exactly once, and no node is lost, after any sequence
// of splits and collapses.
TEST(TestTree, random_splits_and_collapses_keep_a_valid_cut) {
  constexpr std::size_t kNodes = 500;
  Pool p(kNodes);
  const std::uint32_t roots[2] = {p.tree.add_root(0, 0, 0), p.tree.add_root(1, 0, 0)};
  std::mt19937 generator(7);
  const auto rng = [&generator] { return static_cast<std::uint32_t>(generator()); };
  std::vector<std::uint32_t> interior;
  for (int step = 0; step < 5000; ++step) {
    const auto front = p.tree.front();
    if (rng() % 3 != 0) {
      const std::uint32_t node = front[rng() % front.size()];
      p.tree.split(node, rng() % 2 == 0, rng() % 1000, 1 + rng() % 4);
    } else {
      std::uint32_t node = front[rng() % front.size()];
      for (unsigned up = rng() % 3; up > 0 && p.tree[node].parent != kNone; --up)
        node = p.tree[node].parent;
      p.tree.collapse(node);
      EXPECT_TRUE(p.tree.in_front(node));
    }
    std::size_t reachable = 0;
    std::size_t leaves = 0;
    std::vector<std::uint32_t> open(std::begin(roots), std::end(roots));
    while (!open.empty()) {
      const std::uint32_t n = open.back();
      open.pop_back();
      ++reachable;
      ASSERT_EQ(p.tree.in_front(n), p.tree[n].first_child == kNone);
      if (p.tree.in_front(n)) {
        ++leaves;
        ASSERT_EQ(p.tree.front()[p.tree[n].front_slot], n);
      }
      for (std::uint32_t c = p.tree[n].first_child; c != kNone; c = p.tree[c].next_sibling) {
        ASSERT_EQ(p.tree[c].parent, n);
        ASSERT_EQ(p.tree[c].pair, p.tree[n].pair);
        open.push_back(c);
      }
    }
    ASSERT_EQ(leaves, p.tree.front().size());
    ASSERT_EQ(reachable + p.tree.free_nodes(), kNodes);
  }
}

}  // namespace
}  // namespace palpate::levels
