// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/interpolate.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

/// All children are in the front, and those that are near have stopped.
bool children_settled(const Work& work, const Node& parent) noexcept {
  const TestTree& tree = work.tree;
  for (std::uint32_t c = parent.first_child; c != kNone; c = tree[c].next_sibling) {
    if (!tree.in_front(c)) return false;
    if ((tree[c].flags & kStopped) == 0 && work.is_near(tree[c])) return false;
  }
  return true;
}

class Group {
 public:
  Group(Work& work, std::uint32_t parent) noexcept
      : work_(work), parent_(work.tree[parent]), pair_(work.pair_of(parent_)) {}

  /// Measures the parent and mixes. True where the parent takes its children's place.
  bool settle() noexcept {
    const Piece& a = piece_a(pair_, parent_);
    const Piece& b = piece_b(pair_, parent_);
    const convex::Distance d = work_.probe.own(pair_, parent_);
    if (convex::overlaps(d)) return false;
    const Detail missing = detail(pair_, a, b, d, work_.rules);
    parent_.s_star = static_cast<float>(missing.s_star);
    parent_.excess = static_cast<float>(missing.excess);
    const double share = childrens_share(missing.excess);
    if (share >= 1) return false;
    const LeafContact of_parent = contact_of_parent(a, b, d);
    // It would be refined for that (refine.cpp), or says nothing of what its children touch.
    if (of_parent.hidden_a || of_parent.hidden_b) return false;
    mix(of_parent, share);
    return missing.excess <= 1;
  }

 private:
  double childrens_share(double parents_excess) const noexcept {
    if (parents_excess <= 1) return 0;
    double most = 0;
    for (std::uint32_t c = parent_.first_child; c != kNone; c = work_.tree[c].next_sibling) {
      const double excess = static_cast<double>(work_.tree[c].excess);
      if (excess > most) most = excess;
    }
    return parents_excess - 1 >= 1 - most ? 1 : (parents_excess - 1) / (1 - most);
  }

  /// Where there is none, its distance counts as delta: no force.
  LeafContact contact_of_parent(const Piece& a, const Piece& b,
                                const convex::Distance& d) noexcept {
    parent_.contact = 0;
    if (d.lower_bound >= pair_.delta) return {};
    const LeafContact contact = leaf_contact(pair_, a, b, d, parent_.own, pair_.delta,
                                             work_.meter.queries_left(), *work_.memory.scratch);
    work_.probe.charge_parts(contact.queries);
    if (contact.hidden_a || contact.hidden_b) return contact;
    if (!contact.found || contact.interrupted || contact.distance >= pair_.delta) return {};
    keep_contact(pair_, a, b, contact, parent_);
    return contact;
  }

  void mix(const LeafContact& of_parent, double share) noexcept {
    bool any = false;
    const Vec3d centre_m =
        of_parent.found ? work_.report.centre_m(pair_, parent_, of_parent) : Vec3d{};
    for (std::uint32_t c = parent_.first_child; c != kNone; c = work_.tree[c].next_sibling) {
      const Node& child = work_.tree[c];
      if (child.report == kNone) continue;
      any = true;
      if (of_parent.found) {
        work_.report.blend(pair_, child, of_parent, centre_m, share);
      } else {
        work_.report.fade(pair_, child, share);
      }
    }
    if (any || !of_parent.found) return;
    LeafContact fading = of_parent;
    fading.distance = share * pair_.delta + (1 - share) * of_parent.distance;
    if (fading.distance < pair_.delta) {
      static_cast<void>(work_.report.add(pair_, parent_, fading));
      parent_.report = work_.memory.ticks;  // still a mark: nothing mixes with a parent's contact
    }
  }

  Work& work_;
  Node& parent_;
  const PairState& pair_;
};

/// A parent of a stopped node, or a blending node, that this tick has not been to.
bool is_due(const Work& work, std::uint32_t parent) noexcept {
  if (parent == kNone) return false;
  const Node& node = work.tree[parent];
  return node.report != work.memory.ticks && may_mix(work, node) && work.is_near(node) &&
         children_settled(work, node);
}

/// Goes through the stopped nodes, which grow where parents take their children's place, and then
/// through the blending ones.
class Parents {
 public:
  explicit Parents(const Work& work) noexcept : work_(work) {}

  /// The next one that is due; kNone after the last.
  std::uint32_t next() noexcept {
    const TestTree& tree = work_.tree;
    while (stopped_ < work_.stopped.all().size()) {
      const std::uint32_t index = work_.stopped.all()[stopped_++];
      if (tree.in_front(index) && is_due(work_, tree[index].parent)) return tree[index].parent;
    }
    while (blending_ < tree.blending().size()) {
      const std::uint32_t index = tree.blending()[blending_++];
      if (is_due(work_, index)) return index;
    }
    return kNone;
  }

  /// A node has left the blending ones, and the last one may have come into its place.
  void blending_changed() noexcept { blending_ = 0; }

 private:
  const Work& work_;
  std::size_t stopped_ = 0;
  std::size_t blending_ = 0;
};

void replace_children(Work& work, std::uint32_t parent) noexcept {
  work.tree.collapse(parent);
  Node& node = work.tree[parent];
  node.report = kNone;
  clear(node, kOfThisTick);
  set(node, kMeasured);
  work.stopped.add(node, parent);
}

}  // namespace

bool may_mix(const Work& work, const Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  return !is_free(a) && !is_free(b) && !is_too_coarse(pair, a, pair.scale_a, work.rules) &&
         !is_too_coarse(pair, b, pair.scale_b, work.rules);
}

void note_blending(Work& work, std::uint32_t index) noexcept {
  const Node& node = work.tree[index];
  const bool blends = work.rules.interpolate && !work.rules.exact &&
                      static_cast<double>(node.excess) < kOwnContactFrom && may_mix(work, node);
  work.tree.set_blending(index, blends);
}

void interpolate(Work& work) noexcept {
  Parents parents(work);
  for (std::uint32_t parent = parents.next(); parent != kNone; parent = parents.next()) {
    if (work.out_of_budget()) return;
    const bool was_blending = work.tree[parent].blending_slot != kNone;
    work.tree[parent].report = work.memory.ticks;
    if (Group(work, parent).settle()) {
      replace_children(work, parent);
    } else {
      note_blending(work, parent);
    }
    if (was_blending && work.tree[parent].blending_slot == kNone) parents.blending_changed();
  }
}

}  // namespace palpate::levels
