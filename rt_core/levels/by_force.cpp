// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/by_force.hpp"

#include "rt_core/levels/dive.hpp"
#include "rt_core/levels/refine.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

// Shares of delta.
/// A gap up to this is closed.
constexpr double kOpenGap = 0.2;
/// Radius of the larger piece of nodes that dive.
constexpr double kLeastDive = 2;
constexpr double kLargestDive = 5;
/// Of simplified pieces, which have a contact already: a dive adds less, and may be longer.
constexpr double kLargestDiveSimplified = 8;

double gap(const PairState& pair, const Node& node) noexcept {
  double known = pair.delta;
  if (has_dived(node)) {
    const LeafContact contact = remeasured(pair, node);
    // An old contact is a guess along its normal; the distance of its points is certain.
    const bool renewed = (node.flags & kDived) != 0;
    const double at_most = renewed ? contact.distance : contact.upper_bound;
    if (at_most < known) known = at_most;
  }
  return known - certain_now(pair, node);
}

/// A search that has come to its end says all, though its proof may be weaker: witnesses on virtual
/// faces give no contact now, but may give one in the next tick.
bool is_open(const PairState& pair, const Node& node) noexcept {
  return (node.flags & kSearched) == 0 && gap(pair, node) > kOpenGap * pair.delta;
}

bool is_leaf(const PairState& pair, const Node& node) noexcept {
  return piece_a(pair, node).children == 0 && piece_b(pair, node).children == 0;
}

double size_of(const PairState& pair, const Node& node) noexcept {
  const double a = pair.scale_a * static_cast<double>(piece_a(pair, node).radius);
  const double b = pair.scale_b * static_cast<double>(piece_b(pair, node).radius);
  return a > b ? a : b;
}

bool may_dive(const Work& work, const Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  const double size = size_of(pair, node);
  const double largest = work.rules.exact ? kLargestDive : kLargestDiveSimplified;
  return size > kLeastDive * pair.delta && size < largest * pair.delta;
}

void wait_again(Work& work, std::uint32_t index) noexcept {
  const Node& node = work.tree[index];
  if (!work.is_near(node)) return;
  work.wait({force_rank(work, node), work.certain_m(node), index, true});
}

/// Simplified pieces that are apart stand for the original surface while that is too large to be
/// searched: as far as they are apart. A query, and those of open patches.
void guess(Work& work, Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  node.contact = 0;
  if (is_free(a) || is_free(b) || size_of(pair, node) < kLargestDive * pair.delta) return;
  const convex::Distance d = work.probe.own(pair, node);
  if (convex::overlaps(d) || d.lower_bound >= pair.delta) return;
  const LeafContact contact = leaf_contact(pair, a, b, d, node.own, pair.delta,
                                           work.meter.queries_left(), *work.memory.scratch);
  work.probe.charge_parts(contact.queries);
  if (contact.found && contact.distance < pair.delta) keep(pair, a, b, contact, node);
}

void bound(Work& work, std::uint32_t index) noexcept {
  Node& node = work.tree[index];
  const PairState& pair = work.pair_of(node);
  set(node, kBounded);
  static_cast<void>(work.probe.cull(pair, node));
  set_rest(pair, node, certain_now(pair, node));
  if (!work.is_near(node)) {
    node.contact = 0;
  } else if (work.rules.exact && !has_dived(node) && !work.out_of_budget()) {
    guess(work, node);
  }
  wait_again(work, index);
}

void dive_once(Work& work, std::uint32_t index) noexcept {
  Node& node = work.tree[index];
  if ((node.flags & kDived) == 0) {
    find(work, node);
  } else {
    set(node, kImproved);
    improve(work, node);
  }
  wait_again(work, index);
}

void split_further(Work& work, std::uint32_t index) noexcept {
  Node& node = work.tree[index];
  const PairState& pair = work.pair_of(node);
  if ((node.flags & (kRefineA | kRefineB)) == 0) {
    const Piece& a = piece_a(pair, node);
    const Piece& b = piece_b(pair, node);
    const bool all = work.rules.exact;
    if (a.children != 0 && (all || is_free(a))) set(node, kRefineA);
    if (b.children != 0 && (all || is_free(b))) set(node, kRefineB);
  }
  split(work, index);
}

void step(Work& work, std::uint32_t index) noexcept {
  const Node& node = work.tree[index];
  const PairState& pair = work.pair_of(node);
  const bool gives_contact = is_leaf(pair, node) || !work.only_culls(node);
  const bool open = is_open(pair, node);
  if (gives_contact && (node.flags & kMeasured) == 0) {
    measure(work, index);
  } else if (open && (node.flags & kBounded) == 0) {
    bound(work, index);
  } else if (open && (node.flags & kImproved) == 0 && may_dive(work, node)) {
    dive_once(work, index);
  } else {
    split_further(work, index);
  }
}

}  // namespace

double force_rank(const Work& work, const Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  if (is_leaf(pair, node) || is_open(pair, node)) return -gap(pair, node);
  const double depth = pair.delta - certain_now(pair, node);
  const double worth = depth > 0 ? depth * size_of(pair, node) : 0;
  return -kOpenGap * pair.delta * worth / (worth + pair.delta * pair.delta);
}

void refine_by_force(Work& work) noexcept {
  while (!work.waiting.empty() && !work.out_of_budget()) {
    const std::uint32_t index = work.waiting.top().node;
    work.waiting.pop();
    step(work, index);
  }
}

}  // namespace palpate::levels
