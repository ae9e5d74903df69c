// SPDX-License-Identifier: Apache-2.0
// The bounding volume test tree of Sec. 5.2, kept from tick to tick: its leaves are the front.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/convex/distance.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::levels {

inline constexpr std::uint32_t kNone = image::kNone;

/// Node::flags.
inline constexpr std::uint8_t kMeasured = 1;  ///< this tick
inline constexpr std::uint8_t kRefineA = 4;   ///< this tick: near, and a is to be refined
inline constexpr std::uint8_t kRefineB = 8;
inline constexpr std::uint8_t kOfThisTick = kMeasured | kRefineA | kRefineB;

/// Node::contact.
inline constexpr std::uint8_t kFound = 1;  ///< a query, perhaps of an ancestor, gave a contact
/// As kFound, but simplified pieces that were measured since have none (exact queries that may
/// end): it counts where a pair of bodies has no other.
inline constexpr std::uint8_t kDoubtful = 2;

/// A pair of pieces and what is known of their distance. Lengths are in the unit of the body pair.
struct alignas(64) Node {
  // What the scan of the front reads and writes: one cache line. Both bounds were proved when the
  // body pair's odometers stood at travel_at and turn_at, and shrink by the motion since.
  double travel_at = 0;
  double turn_at = 0;
  float lower_bound = 0;  ///< while this is delta or more, the node need not be looked at: neither
                          ///< its pieces nor what is below them give a contact
  float certified = 0;    ///< lower bound of the distance of the two pieces' original descendants
  float reach = 0;  ///< farthest point of piece a from the centre of body a: lever arm of turning
  std::uint16_t pair = 0;    ///< body pair
  std::uint8_t contact = 0;  ///< 0: none is kept at the witnesses; else kFound, kDoubtful
  std::uint8_t flags = 0;
  std::uint32_t piece_a = 0;
  std::uint32_t piece_b = 0;
  // Links.
  std::uint32_t parent = kNone;
  std::uint32_t first_child = kNone;
  std::uint32_t next_sibling = kNone;  ///< also links the free list
  std::uint32_t front_slot = kNone;    ///< place in the front; kNone inside the tree
  // Of the last query.
  Vec3f witness_a{};  ///< of the contact, in the coordinates of a
  Vec3f witness_b{};  ///< in the coordinates of b
  Vec3f normal{};     ///< from b to a, in the coordinates of a: of the contact, as long as the
                      ///< share of it that is felt; without one, of the last query that parted the
                      ///< hulls, zero before the first
  float slack = 0;    ///< the original surfaces are at most this farther apart than the witnesses
  float s_star = 0;   ///< eq. 7; an ancestor's until the node is measured
  // Warm starts.
  convex::Cache own;      ///< of the pieces' hulls
  convex::Cache culling;  ///< of their culling hulls
};
static_assert(offsetof(Node, witness_a) <= 64 && sizeof(Node) == 192);

inline void set(Node& node, std::uint8_t flags) noexcept {
  node.flags = static_cast<std::uint8_t>(node.flags | flags);
}
inline void clear(Node& node, std::uint8_t flags) noexcept {
  node.flags = static_cast<std::uint8_t>(node.flags & ~flags);
}

/// A fixed pool of nodes, one tree for every body pair, all fronts in one array. A node is replaced
/// by *all* its children or all children by their parent, so that the front covers every pair of
/// surface regions at every moment.
class TestTree {
 public:
  /// Tells where the nodes are, or are now: their values stay.
  /// @param nodes, front  of equal length: the capacity
  void attach(std::span<Node> nodes, std::span<std::uint32_t> front) noexcept;

  /// Empties the pool.
  void clear() noexcept;

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
  [[nodiscard]] std::size_t used_nodes() const noexcept { return nodes_.size() - free_count_; }

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
