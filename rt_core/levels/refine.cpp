// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/refine.hpp"

#include "rt_core/levels/leaf_contact.hpp"
#include "rt_core/levels/start.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

/// Distances that differ by no more, in units, are equal: often they end at one and the same
/// vertex.
constexpr double kEqual = 1e-6;

void allow(Node& node, bool a, bool b) noexcept {
  if (a) set(node, kRefineA);
  if (b) set(node, kRefineB);
}

void wait_for_split(Work& work, std::uint32_t index) noexcept {
  const Node& node = work.tree[index];
  const PairState& pair = work.pair_of(node);
  const double certified = certified_now(pair, node);
  work.wait({rank(work, node, certified), certified * pair.unit_m, index, true});
}

/// Until it is measured, a child stands where its parent did.
void inherit(const Node& parent, Node& child) noexcept {
  copy_contact(parent, child);
  child.s_star = parent.s_star;
}

void split(Work& work, std::uint32_t index) noexcept {
  Node& parent = work.tree[index];
  const PairState& pair = work.pair_of(parent);
  const Piece& a = piece_a(pair, parent);
  const Piece& b = piece_b(pair, parent);
  const bool split_a =
      splits_a(pair, a, b, (parent.flags & kRefineA) != 0, (parent.flags & kRefineB) != 0);
  const Piece& piece = split_a ? a : b;
  if (!work.tree.split(index, split_a, piece.first_child, piece.children)) {
    work.result.truncated_by_memory = true;
    work.leave(index, work.certified_m(parent));
    return;
  }
  work.tally.count([&](auto& counters) {
    ++counters.splits;
    raise_mark(counters.most_nodes, work.tree.used_nodes());
  });
  for (std::uint32_t c = parent.first_child; c != kNone; c = work.tree[c].next_sibling) {
    Node& child = work.tree[c];
    begin(pair, child, certified_now(pair, parent));
    inherit(parent, child);
    wait_if_near(work, c);
  }
}

/// The contact kept until now is none, or in an exact query none for sure only where the pieces are
/// the original ones.
void doubt(const Work& work, Node& node, bool refines) noexcept {
  node.contact = work.rules.exact && refines && node.contact != 0 ? kDoubtful : 0;
}

/// Keeps the contact of two pieces in the node, and reports it where refinement stops here.
/// @return what leaf_contact() says
LeafContact measure_contact(Work& work, Node& node, const convex::Distance& d,
                            bool stops) noexcept {
  const PairState& pair = work.pair_of(node);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  const LeafContact contact = leaf_contact(pair, a, b, d, node.own, pair.delta,
                                           work.meter.queries_left(), *work.memory.scratch);
  work.probe.charge_parts(contact.queries);
  doubt(work, node, !stops);
  if (contact.interrupted) {
    work.result.truncated_by_units = true;
    work.leave_unresolved(work.certified_m(node), node);
  }
  if (!contact.found) return contact;
  const bool original = !is_simplified(a) && !is_simplified(b);
  if (original && !contact.interrupted) prove(pair, node, contact.lower_bound);
  work.note_cap(pair, contact);
  if (contact.distance >= pair.delta || contact.share == 0) return contact;
  keep_contact(pair, a, b, contact, node);
  if (stops) work.add_contact(node, contact);
  return contact;
}

/// No detail is missing, but what there is of it gives no contact where there may be one: a cut
/// through several levels has gaps between pieces whose surfaces end elsewhere at each of them.
/// Refined on, unless a contact is nearer anyway.
void refine_hidden(const Work& work, const Node& node, const convex::Distance& d,
                   const LeafContact& contact, Detail& missing) noexcept {
  const PairState& pair = work.pair_of(node);
  if (pair.nearest <= d.distance + kEqual) return;
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  missing.refine_a = contact.hidden_a && is_simplified(a) && a.children != 0;
  missing.refine_b = contact.hidden_b && is_simplified(b) && b.children != 0;
}

/// A node that gives no contact itself.
void measure_bound(Work& work, std::uint32_t index) noexcept {
  Node& node = work.tree[index];
  const PairState& pair = work.pair_of(node);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  static_cast<void>(work.probe.cull(pair, node, Ask::nearness));
  set_lower_bound(pair, node, certified_now(pair, node));
  if (!work.is_near(node)) {
    node.contact = 0;
    return;
  }
  const bool all = work.rules.exact;
  allow(node, a.children != 0 && (all || is_free(a)), b.children != 0 && (all || is_free(b)));
  split(work, index);
}

void measure_metric(Work& work, std::uint32_t index) noexcept {
  Node& node = work.tree[index];
  const PairState& pair = work.pair_of(node);
  const convex::Distance d = work.probe.own(pair, node);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  Detail missing = detail(pair, a, b, d, work.rules);
  if (work.rules.exact) {
    missing.refine_a = a.children != 0;
    missing.refine_b = b.children != 0;
  }
  node.s_star = static_cast<float>(missing.s_star);
  if (work.proves_far(node, d)) {
    node.contact = 0;
    return;
  }
  bool refines = missing.refine_a || missing.refine_b;
  if (d.lower_bound < pair.delta) {
    // Overlap of simplified hulls is no contact: the last one, of an ancestor apart, stands.
    const LeafContact contact =
        refines && convex::overlaps(d) ? LeafContact{} : measure_contact(work, node, d, !refines);
    if (!refines) refine_hidden(work, node, d, contact, missing);
    refines = missing.refine_a || missing.refine_b;
  } else {
    doubt(work, node, refines);
  }
  if (refines) {
    allow(node, missing.refine_a, missing.refine_b);
    wait_for_split(work, index);
  } else {
    work.stopped.add(index);
  }
}

void measure(Work& work, std::uint32_t index) noexcept {
  Node& node = work.tree[index];
  const PairState& pair = work.pair_of(node);
  set(node, kMeasured);
  const bool leaves = piece_a(pair, node).children == 0 && piece_b(pair, node).children == 0;
  if (!leaves && work.only_culls(node)) {
    measure_bound(work, index);
  } else {
    measure_metric(work, index);
  }
}

}  // namespace

void refine(Work& work) noexcept {
  while (!work.waiting.empty() && !work.out_of_budget()) {
    const std::uint32_t index = work.next();
    if ((work.tree[index].flags & kMeasured) != 0) {
      split(work, index);
    } else {
      measure(work, index);
    }
  }
}

}  // namespace palpate::levels
