// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/start.hpp"

namespace palpate::levels {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A move by more than this share of the radius (or of delta, where that is more) starts from the
/// roots: an old front says nothing about a far pose.
constexpr double kJumpRadius = 0.05;
constexpr double kJumpDelta = 2;
/// Of the distance of two spheres, in units.
constexpr double kSphereRounding = 1e-9;
/// The front may be this much larger than what the budget is expected to measure: the estimate
/// wavers, and a front that is cut back every other tick would be felt.
constexpr double kFrontOverBudget = 1.25;
/// One that is larger is cut back to this: what is left of the budget refines where it is felt.
constexpr double kFrontCut = 0.5;
/// It gives up what keeps no contact nearer than these shares of delta, one
/// after the other, and then one level of all after the other.
constexpr double kCutFrom[] = {1, 0.75, 0.5, 0.25, 0};
/// For cuts a budget of fewer units counts as this many. What is near about one contact has to fit
/// into the front, measured in turns where a tick does not do for all of it: a smaller cut would
/// split its way down to the contact again in each tick, through the largest hulls, and not arrive.
constexpr double kLeastAffordable = 32;
/// The front's nodes lie anywhere in the pool: this many are on their way from memory.
constexpr std::size_t kAhead = 8;

bool jumped(const PairState& pair) noexcept {
  const double moved = pair.last_travel + pair.last_turn;
  const double far = kJumpDelta * pair.delta > kJumpRadius ? kJumpDelta * pair.delta : kJumpRadius;
  return moved > far;
}

void restart(Work& work, PairState& pair) noexcept {
  Node& root = work.tree[pair.root];
  work.tree.collapse(pair.root);
  root.contact = 0;
  root.s_star = std::numeric_limits<float>::infinity();
  begin(pair, root, -kInfinity);
  pair.fresh = false;
}

/// The root short cut. A root in the front is measured anyway.
void rise_if_apart(Work& work, PairState& pair) noexcept {
  Node& root = work.tree[pair.root];
  if (work.tree.in_front(pair.root) || work.out_of_budget()) return;
  if (work.is_near(root) && !work.proves_far(root)) return;
  work.tree.collapse(pair.root);
  root.contact = 0;
}

void place(Work& work, PairState& pair) noexcept {
  pair.nearest = pair.delta;
  pair.apart = -kInfinity;
  const Node& root = work.tree[pair.root];
  const bool apart = sphere_distance(pair, piece_a(pair, root), piece_b(pair, root)) >= pair.delta;
  if (pair.fresh || apart || jumped(pair)) {
    restart(work, pair);
  } else {
    rise_if_apart(work, pair);
  }
  pair.apart = certified_now(pair, root);
}

/// Where the motion bound has run out the spheres may still do: they cost no query.
void renew(Work& work, Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  if (!work.is_near(node)) return;
  const double spheres = sphere_distance(pair, piece_a(pair, node), piece_b(pair, node));
  if (spheres - kSphereRounding > certified_now(pair, node))
    prove(pair, node, spheres - kSphereRounding);
  if (spheres < pair.delta + kSphereRounding) return;
  set_lower_bound(pair, node, spheres - kSphereRounding);
  node.contact = 0;
}

double count_near(const Work& work) noexcept {
  double near = 0;
  for (const std::uint32_t index : work.tree.front())
    near += work.is_near(work.tree[index]) ? 1 : 0;
  return near;
}

/// Those of its children that are in the front.
double near_children(const Work& work, const Node& parent) noexcept {
  double near = 0;
  for (std::uint32_t c = parent.first_child; c != kNone; c = work.tree[c].next_sibling)
    near += work.tree.in_front(c) && work.is_near(work.tree[c]) ? 1 : 0;
  return near;
}

/// Delta less what is felt of the contact that a node keeps, at its points by now; delta where it
/// keeps none.
double kept_distance(const PairState& pair, const Node& node) noexcept {
  if (node.contact == 0) return pair.delta;
  const LeafContact contact = remeasured(pair, node);
  return pair.delta - contact.share * (pair.delta - contact.distance);
}

/// To its parent, where that has none that is nearer.
void pass_contact_up(Work& work, const PairState& pair, const Node& node) noexcept {
  if (node.contact == 0) return;
  Node& above = work.tree[node.parent];
  const bool better =
      above.contact == 0 || node.contact < above.contact ||
      (node.contact == above.contact && kept_distance(pair, node) < kept_distance(pair, above));
  if (better) copy_contact(node, above);
}

/// Every ancestor gets the nearest contact below it, so that none is lost to a cut. What it kept
/// when it was split it forgets: that has aged unseen, and may look deeper by now than anything
/// below it. Depth first, children before parents: each node of the tree is visited twice at most.
void carry_contacts_up(Work& work, const PairState& pair) noexcept {
  std::uint32_t at = pair.root;
  for (;;) {
    for (; !work.tree.in_front(at); at = work.tree[at].first_child) work.tree[at].contact = 0;
    for (;; at = work.tree[at].parent) {
      if (at == pair.root) return;
      pass_contact_up(work, pair, work.tree[at]);
      if (work.tree[at].next_sibling != kNone) break;
    }
    at = work.tree[at].next_sibling;
  }
}

/// Near front nodes whose parent keeps nothing nearer than `from` (share of delta) give way to it,
/// until `most` are near. False where none did.
bool raise_near(Work& work, double from, double most) noexcept {
  bool raised = false;
  double near = count_near(work);
  for (std::size_t i = 0; i < work.tree.front().size() && near > most; ++i) {
    const std::uint32_t index = work.tree.front()[i];
    const std::uint32_t parent = work.tree[index].parent;
    if (parent == kNone || !work.is_near(work.tree[index])) continue;
    Node& above = work.tree[parent];
    const PairState& pair = work.pair_of(above);
    if (above.contact == kFound && kept_distance(pair, above) < from * pair.delta) continue;
    near += 1 - near_children(work, above);
    work.tree.collapse(parent);  // puts other nodes into this place
    raised = true;
  }
  return raised;
}

bool is_affordable(const Work& work, double most) noexcept {
  return static_cast<double>(work.tree.front().size()) <= most || count_near(work) <= most;
}

/// What is farthest goes first: it is felt least.
void cut_back(Work& work, double in_budget) noexcept {
  const double affordable = in_budget > kLeastAffordable ? in_budget : kLeastAffordable;
  if (is_affordable(work, kFrontOverBudget * affordable)) return;
  const double most = kFrontCut * affordable;
  for (const PairState& pair : work.memory.pairs) carry_contacts_up(work, pair);
  for (const double from : kCutFrom) {
    static_cast<void>(raise_near(work, from, most));
    if (is_affordable(work, most)) return;
  }
  for (std::uint32_t round = 0; round < 2 * image::kMaxLevels; ++round) {
    if (!raise_near(work, -kInfinity, most) || is_affordable(work, most)) return;
  }
}

/// Something below the node is at most this far: the points that it keeps, as far as they are apart
/// by now, and what the original surfaces may be farther apart than those; at most delta.
double known_distance(const PairState& pair, const Node& node) noexcept {
  if (node.contact != kFound) return pair.delta;
  const double most = remeasured(pair, node).upper_bound + static_cast<double>(node.slack);
  return most < pair.delta ? most : pair.delta;
}

}  // namespace

void start(Work& work) noexcept {
  for (PairState& pair : work.memory.pairs) place(work, pair);
  const double affordable = work.meter.queries_affordable(work.memory.query_ns);
  cut_back(work, affordable);
  const std::span<const std::uint32_t> front = work.tree.front();
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (i + kAhead < front.size()) __builtin_prefetch(&work.tree[front[i + kAhead]], 1);
    const std::uint32_t index = front[i];
    Node& node = work.tree[index];
    clear(node, kOfThisTick);
    renew(work, node);
    wait_if_near(work, index);
  }
}

void wait_if_near(Work& work, std::uint32_t index) noexcept {
  const Node& node = work.tree[index];
  if (!work.is_near(node)) return;
  const PairState& pair = work.pair_of(node);
  const bool ranked = work.only_culls(node);
  const double certified = certified_now(pair, node);
  work.wait(
      {ranked ? rank(work, node, certified) : certified, certified * pair.unit_m, index, ranked});
}

double rank(const Work& work, const Node& node, double lower) noexcept {
  const PairState& pair = work.pair_of(node);
  if (work.rules.exact && !work.may_end) return lower;
  if (work.rules.order == Order::force && work.may_end) return lower - known_distance(pair, node);
  // What is missing counts for no more than what the parent missed: refinement has an order.
  const float of_parent = node.parent == kNone ? node.s_star : work.tree[node.parent].s_star;
  return -static_cast<double>(node.s_star < of_parent ? node.s_star : of_parent);
}

}  // namespace palpate::levels
