// SPDX-License-Identifier: Apache-2.0
// The bounding volume test tree of Sec. 5.2, kept from tick to tick: its leaves are the front.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/convex/distance.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::levels {

inline constexpr std::uint32_t kNone = image::kNone;

/// A pair of pieces and what is known of their distance. Lengths are in the unit of the body pair.
struct alignas(64) Node {
  // What the scan of the front reads.
  float lower = 0;  ///< proved lower bound of the distance of the two pieces' original descendants,
                    ///< at the time when
  double travel_at = 0;  ///< ... the body pair's odometers stood here
  double turn_at = 0;
  float reach = 0;  ///< farthest point of piece a from the centre of body a: lever arm of turning
  std::uint16_t pair = 0;  ///< body pair
  std::int8_t contact =
      0;  ///< the last query gave a contact at the witnesses: 1 apart, -1 overlapping; 0 none
  std::uint32_t piece_a = 0;
  std::uint32_t piece_b = 0;
  // Links.
  std::uint32_t parent = kNone;
  std::uint32_t first_child = kNone;
  std::uint32_t next_sibling = kNone;  ///< also links the free list
  std::uint32_t front_slot = kNone;    ///< place in the front; kNone inside the tree
  // Warm start.
  convex::Cache cache;
  Vec3f witness_a{};  ///< in the coordinates of a and of b
  Vec3f witness_b{};
};
static_assert(sizeof(Node) == 128);

/// A fixed pool of nodes, one tree for every body pair, all fronts in one array. A node is replaced
/// by *all* its children or all children by their parent, so that the front covers every pair of
/// surface regions at every moment.
class TestTree {
 public:
  TestTree() = default;
  /// @param nodes, front  of equal length: the capacity
  TestTree(std::span<Node> nodes, std::span<std::uint32_t> front) noexcept;

  /// A new tree of one node. Returns its index, or kNone where the pool is empty.
  std::uint32_t add_root(std::uint16_t pair, std::uint32_t piece_a, std::uint32_t piece_b) noexcept;

  /// Replaces a front node by the pairs of one of its pieces' children with the other piece.
  /// Children inherit nothing but the pair. False, and nothing changed, where the pool has fewer
  /// free nodes than children.
  bool split(std::uint32_t node, bool split_a, std::uint32_t first_child_piece,
             std::uint32_t children) noexcept;

  /// Replaces everything below a node by the node itself. O(nodes below).
  void collapse(std::uint32_t node) noexcept;

  [[nodiscard]] bool in_front(std::uint32_t node) const noexcept {
    return nodes_[node].front_slot != kNone;
  }
  [[nodiscard]] std::span<const std::uint32_t> front() const noexcept {
    return front_.first(front_size_);
  }
  [[nodiscard]] Node& operator[](std::uint32_t node) noexcept { return nodes_[node]; }
  [[nodiscard]] const Node& operator[](std::uint32_t node) const noexcept { return nodes_[node]; }
  [[nodiscard]] std::uint32_t free_nodes() const noexcept { return free_count_; }

 private:
  std::uint32_t take() noexcept;
  void give_back(std::uint32_t node) noexcept;
  void enter_front(std::uint32_t node) noexcept;
  void leave_front(std::uint32_t node) noexcept;

  std::span<Node> nodes_;
  std::span<std::uint32_t> front_;
  std::uint32_t front_size_ = 0;
  std::uint32_t free_head_ = kNone;
  std::uint32_t free_count_ = 0;
};

}  // namespace palpate::levels
