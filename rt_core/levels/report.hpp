// SPDX-License-Identifier: Apache-2.0
// The contacts of a tick while they are gathered.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "rt_core/convex/pressure.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/levels/leaf_contact.hpp"
#include "rt_core/levels/test_tree.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::levels {

struct QueryResult;

/// Keeps a contact in its node: as material points, with the share of it that is felt, and how much
/// farther apart the original surfaces can be (the surface deviations of both pieces).
void keep_contact(const PairState& pair, const image::Piece& a, const image::Piece& b,
                  const LeafContact& contact, Node& node) noexcept;

/// Gives a node the contact kept in another one, in or above whose subtree it is.
inline void copy_contact(const Node& from, Node& to) noexcept {
  to.contact = from.contact;
  to.witness_a = from.witness_a;
  to.witness_b = from.witness_b;
  to.normal = from.normal;
  to.slack = from.slack;
}

/// The contact kept in a node, measured again at its material points, with its normal as it turned
/// with a. While these are apart along the normal it is as long as they are; overlap is what they
/// overlap along the normal, less what they have slid: so it ends where the bodies have parted or
/// slid on. No more of it is felt than when it was kept, and never more than what is proved of the
/// node allows. The points themselves bound the true distance from above. O(1).
LeafContact remeasured(const PairState& pair, const Node& node) noexcept;

class Report {
 public:
  Report(std::span<Contact> contacts, convex::PressureScratch& scratch) noexcept
      : contacts_(contacts), scratch_(scratch) {}

  /// Adds the contact of a node. False where there is no room.
  bool add(const PairState& pair, const Node& node, const LeafContact& contact) noexcept;

  /// Added so far.
  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }

  /// Fills in contacts, min_distance_m and upper_m.
  void finish(QueryResult& result) noexcept;

 private:
  /// Where the force of a node's contact acts, in the world (convex/pressure.hpp).
  [[nodiscard]] Vec3d centre_m(const PairState& pair, const Node& node,
                               const LeafContact& contact) const noexcept;
  void note_upper(const PairState& pair, const Node& node, const LeafContact& contact) noexcept;

  std::span<Contact> contacts_;
  convex::PressureScratch& scratch_;
  std::uint32_t count_ = 0;
  double upper_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace palpate::levels
