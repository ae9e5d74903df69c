// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/test_tree.hpp"

#include "rt_core/base/assert.hpp"

namespace palpate::levels {

void TestTree::attach(std::span<Node> nodes, std::span<std::uint32_t> front) noexcept {
  PALPATE_ASSERT(nodes.size() == front.size());
  nodes_ = nodes;
  front_ = front;
}

void TestTree::clear() noexcept {
  front_size_ = free_count_ = 0;
  free_head_ = kNone;
  // Lowest index first, so that the order of nodes is the same on every run.
  for (std::size_t i = nodes_.size(); i > 0; --i) {
    nodes_[i - 1] = Node{};
    give_back(static_cast<std::uint32_t>(i - 1));
  }
}

std::uint32_t TestTree::take() noexcept {
  const std::uint32_t node = free_head_;
  if (node == kNone) return kNone;
  free_head_ = nodes_[node].next_sibling;
  --free_count_;
  nodes_[node] = Node{};
  return node;
}

void TestTree::give_back(std::uint32_t node) noexcept {
  nodes_[node].next_sibling = free_head_;
  free_head_ = node;
  ++free_count_;
}

void TestTree::enter_front(std::uint32_t node) noexcept {
  nodes_[node].front_slot = front_size_;
  front_[front_size_++] = node;
}

void TestTree::leave_front(std::uint32_t node) noexcept {
  const std::uint32_t slot = nodes_[node].front_slot;
  PALPATE_ASSERT(slot < front_size_ && front_[slot] == node);
  const std::uint32_t last = front_[--front_size_];
  front_[slot] = last;
  nodes_[last].front_slot = slot;
  nodes_[node].front_slot = kNone;
}

std::uint32_t TestTree::add_root(std::uint16_t pair, std::uint32_t piece_a,
                                 std::uint32_t piece_b) noexcept {
  const std::uint32_t node = take();
  if (node == kNone) return kNone;
  nodes_[node].pair = pair;
  nodes_[node].piece_a = piece_a;
  nodes_[node].piece_b = piece_b;
  enter_front(node);
  return node;
}

bool TestTree::split(std::uint32_t node, bool split_a, std::uint32_t first_child_piece,
                     std::uint32_t children) noexcept {
  PALPATE_ASSERT(in_front(node) && children > 0);
  if (free_count_ < children) return false;
  leave_front(node);
  const Node& parent = nodes_[node];
  std::uint32_t previous = kNone;
  for (std::uint32_t i = 0; i < children; ++i) {
    const std::uint32_t child = take();
    nodes_[child].pair = parent.pair;
    nodes_[child].piece_a = split_a ? first_child_piece + i : parent.piece_a;
    nodes_[child].piece_b = split_a ? parent.piece_b : first_child_piece + i;
    nodes_[child].parent = node;
    if (previous == kNone) {
      nodes_[node].first_child = child;
    } else {
      nodes_[previous].next_sibling = child;
    }
    previous = child;
    enter_front(child);
  }
  return true;
}

void TestTree::collapse(std::uint32_t top) noexcept {
  if (in_front(top)) return;
  // Leaves first, without recursion: go down to a leaf, free it, continue at its sibling or, after
  // the last one, its parent.
  std::uint32_t node = nodes_[top].first_child;
  while (node != top) {
    if (nodes_[node].first_child != kNone) {
      node = nodes_[node].first_child;
      continue;
    }
    const std::uint32_t sibling = nodes_[node].next_sibling;
    const std::uint32_t parent = nodes_[node].parent;
    if (in_front(node)) leave_front(node);
    give_back(node);
    nodes_[parent].first_child = sibling;
    node = sibling != kNone ? sibling : parent;
  }
  enter_front(top);
}

}  // namespace palpate::levels
