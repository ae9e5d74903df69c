// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/interpolate.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

class Group {
 public:
  Group(const Interpolation& on, std::uint32_t parent) noexcept
      : on_(on), parent_(parent), pair_(on.pairs[on.tree[parent].pair]) {}

  /// Measures the parent and mixes. True where the parent takes its children's place.
  bool settle() noexcept {
    Node& node = on_.tree[parent_];
    const Piece& a = piece_a(pair_, node);
    const Piece& b = piece_b(pair_, node);
    const convex::Distance d = on_.probe.own(pair_, node);
    if (convex::overlaps(d)) return false;
    const Detail missing = detail(pair_, a, b, d, on_.rules);
    node.s_star = static_cast<float>(missing.s_star);
    node.excess = static_cast<float>(missing.excess);
    const double share = childrens_share(missing.excess);
    if (share >= 1) return false;
    mix(contact_of_parent(a, b, d), share);
    return missing.excess <= 1;
  }

 private:
  /// 1 where not all near children stopped.
  double childrens_share(double parents_excess) const noexcept {
    double most = 0;
    for (std::uint32_t c = first_child(); c != kNone; c = on_.tree[c].next_sibling) {
      const Node& child = on_.tree[c];
      const bool open = (child.flags & kStopped) == 0 && is_near(pair_, child);
      if (!on_.tree.in_front(c) || open) return 1;
      if (static_cast<double>(child.excess) > most) most = static_cast<double>(child.excess);
    }
    if (parents_excess <= 1) return 0;
    return parents_excess - 1 >= 1 - most ? 1 : (parents_excess - 1) / (1 - most);
  }

  /// Where there is none, its distance counts as delta: no force.
  LeafContact contact_of_parent(const Piece& a, const Piece& b,
                                const convex::Distance& d) noexcept {
    Node& node = on_.tree[parent_];
    node.contact = 0;
    if (d.lower_bound >= pair_.delta) return {};
    const LeafContact contact =
        leaf_contact(pair_, a, b, d, node.own, pair_.delta, on_.meter.queries_left(), on_.scratch);
    on_.probe.charge(contact.queries);
    if (!contact.found || contact.interrupted || contact.distance >= pair_.delta) return {};
    keep(pair_, a, b, contact, node);
    return contact;
  }

  void mix(const LeafContact& of_parent, double share) noexcept {
    bool any = false;
    for (std::uint32_t c = first_child(); c != kNone; c = on_.tree[c].next_sibling) {
      const Node& child = on_.tree[c];
      if (child.report == kNone) continue;
      any = true;
      on_.report.blend(pair_, child, of_parent.found ? of_parent : without_force(child), share);
    }
    if (any || !of_parent.found) return;
    LeafContact fading = of_parent;
    fading.distance = share * pair_.delta + (1 - share) * of_parent.distance;
    if (fading.distance < pair_.delta)
      static_cast<void>(on_.report.add(pair_, on_.tree[parent_], fading));
  }

  /// The child's own points and normal, at delta.
  LeafContact without_force(const Node& child) const noexcept {
    LeafContact contact = remeasured(pair_, child);
    contact.distance = pair_.delta;
    return contact;
  }

  [[nodiscard]] std::uint32_t first_child() const noexcept { return on_.tree[parent_].first_child; }

  const Interpolation& on_;
  std::uint32_t parent_;
  const PairState& pair_;
};

bool has_metric(const Interpolation& on, std::uint32_t index) noexcept {
  const Node& node = on.tree[index];
  const PairState& pair = on.pairs[node.pair];
  return !is_free(piece_a(pair, node)) && !is_free(piece_b(pair, node));
}

bool is_due(const Interpolation& on, std::uint32_t index, std::uint32_t parent) noexcept {
  const Node& node = on.tree[parent];
  const bool matters =
      (on.tree[index].flags & kStopped) != 0 || static_cast<double>(node.excess) < kOwnContactFrom;
  const PairState& pair = on.pairs[node.pair];
  return matters && has_metric(on, parent) && is_near(pair, node);
}

}  // namespace

void interpolate(const Interpolation& on) noexcept {
  for (std::size_t i = 0; i < on.tree.front().size();) {
    const std::uint32_t index = on.tree.front()[i];
    const std::uint32_t parent = on.tree[index].parent;
    if (parent == kNone || on.tree[parent].report == on.tick || !is_due(on, index, parent)) {
      ++i;
      continue;
    }
    if (on.meter.out_of_units() || on.meter.out_of_time()) return;
    on.tree[parent].report = on.tick;
    if (!Group(on, parent).settle()) {
      ++i;
      continue;
    }
    on.tree.collapse(parent);  // another node moves to this place
    Node& node = on.tree[parent];
    node.report = kNone;
    clear(node, kOfThisTick);
    set(node, kMeasured);
    on.stopped.add(node, parent);
  }
}

}  // namespace palpate::levels
