// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/levels_engine.hpp"

#include <limits>

#include "rt_core/base/queue.hpp"
#include "rt_core/levels/interpolate.hpp"
#include "rt_core/levels/leaf_contact.hpp"
#include "rt_core/levels/probe.hpp"
#include "rt_core/levels/report.hpp"
#include "rt_core/levels/stopped.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A move by more than this share of the radius (or of delta, where that is more) starts from the
/// roots: an old front says nothing about a far pose.
constexpr double kJumpRadius = 0.05;
constexpr double kJumpDelta = 2;
/// The front may be this much larger than what the budget is expected to measure: the estimate
/// wavers, and a front that is cut back every other tick would be felt.
constexpr double kFrontOverBudget = 1.25;
/// Raising looks at this many front nodes a tick, plus this share of them, and spends at most so
/// many queries; tightening likewise.
constexpr std::uint32_t kRaiseScan = 64;
constexpr std::uint32_t kRaiseScanShare = 32;
constexpr std::uint64_t kSpareQueries = 16;
constexpr std::uint64_t kSpareQueryShare = 8;

struct Earlier {
  bool operator()(const Waiting& a, const Waiting& b) const noexcept {
    if (a.later != b.later) return b.later;
    if (a.rank != b.rank) return a.rank < b.rank;
    return a.lower_m < b.lower_m || (a.lower_m == b.lower_m && a.node < b.node);
  }
};
using WaitQueue = MinQueue<Waiting, Earlier>;

/// Approximates the surface below it.
bool is_simplified(const Piece& piece) noexcept {
  return piece.surface_deviation > 0 || piece.hausdorff > 0;
}

class Query {
 public:
  Query(QueryMemory& memory, const Rules& rules, Meter& meter) noexcept
      : memory_(memory),
        tree_(memory.tree),
        rules_(rules),
        meter_(meter),
        probe_(rules, meter),
        report_(memory.contacts),
        waiting_(memory.waiting),
        stopped_(memory.stopped) {}

  QueryResult run() noexcept {
    ++memory_.ticks;
    for (PairState& pair : memory_.pairs) restart_if_far(pair);
    start();
    refine();
    if (!truncated()) {
      if (rules_.interpolate && !rules_.exact)
        interpolate({memory_.pairs, tree_, rules_, probe_, report_, stopped_, *memory_.scratch,
                     meter_, memory_.ticks});
      raise();
      tighten();
    }
    meter_.begin_tail();
    settle();
    return finish();
  }

 private:
  PairState& pair_of(const Node& node) noexcept { return memory_.pairs[node.pair]; }
  bool truncated() const noexcept {
    return result_.truncated_by_time || result_.truncated_by_units;
  }

  void restart_if_far(PairState& pair) noexcept {
    Node& root = tree_[pair.root];
    const double moved = pair.last_travel + pair.last_turn;
    const double far =
        kJumpDelta * pair.delta > kJumpRadius ? kJumpDelta * pair.delta : kJumpRadius;
    const bool apart =
        sphere_distance(pair, piece_a(pair, root), piece_b(pair, root)) >= pair.delta;
    if (!pair.fresh && !apart && moved <= far) return;
    tree_.collapse(pair.root);
    root.contact = 0;
    root.s_star = root.excess = std::numeric_limits<float>::infinity();
    begin(pair, root, -kInfinity);
    pair.fresh = false;
  }

  bool is_near(const Node& node) noexcept { return levels::is_near(pair_of(node), node); }

  /// All near front nodes wait to be measured.
  void start() noexcept {
    const double most = kFrontOverBudget * meter_.queries_affordable(memory_.query_ns);
    for (std::uint32_t round = 0; round < 2 * image::kMaxLevels; ++round) {
      if (static_cast<double>(tree_.front().size()) <= most || count_near() <= most) break;
      if (!raise_near()) break;
    }
    for (const std::uint32_t index : tree_.front()) {
      Node& node = tree_[index];
      clear(node, kOfThisTick);
      node.report = kNone;
      wait_if_near(index);
    }
  }

  double count_near() noexcept {
    double near = 0;
    for (const std::uint32_t index : tree_.front()) near += is_near(tree_[index]) ? 1 : 0;
    return near;
  }

  /// Every near front node gives way to its parent. False where all are roots.
  bool raise_near() noexcept {
    bool raised = false;
    for (std::size_t i = 0; i < tree_.front().size();) {
      const std::uint32_t index = tree_.front()[i];
      const std::uint32_t parent = tree_[index].parent;
      ++i;
      if (parent == kNone || !is_near(tree_[index])) continue;
      tree_.collapse(parent);  // puts other nodes into this place
      raised = true;
    }
    return raised;
  }

  void wait_if_near(std::uint32_t index) noexcept {
    const Node& node = tree_[index];
    const PairState& pair = pair_of(node);
    if (!is_near(node)) return;
    const bool later = only_culls(pair, node);
    const double certain = certain_now(pair, node);
    waiting_.push({later ? rank(node, certain) : certain, certain * pair.unit_m, index, later});
  }

  /// Gives no contact itself, but has to be split wherever it is near.
  bool only_culls(const PairState& pair, const Node& node) const noexcept {
    const Piece& a = piece_a(pair, node);
    const Piece& b = piece_b(pair, node);
    return rules_.exact || is_free(a) || is_free(b);
  }

  bool budget_left() noexcept {
    if (meter_.out_of_units()) {
      result_.truncated_by_units = true;
    } else if (meter_.out_of_time()) {
      result_.truncated_by_time = true;
    } else {
      return true;
    }
    return false;
  }

  void refine() noexcept {
    while (!waiting_.empty() && budget_left()) {
      const std::uint32_t index = waiting_.top().node;
      waiting_.pop();
      if ((tree_[index].flags & kMeasured) != 0) {
        split(index);
      } else {
        measure(index);
      }
    }
  }

  void wait_for_split(std::uint32_t index) noexcept {
    const Node& node = tree_[index];
    const PairState& pair = pair_of(node);
    const double certain = certain_now(pair, node);
    waiting_.push({rank(node, certain), certain * pair.unit_m, index, true});
  }

  static void allow(Node& node, bool a, bool b) noexcept {
    if (a) set(node, kRefineA);
    if (b) set(node, kRefineB);
  }

  /// What is missing counts for no more than what the parent missed: refinement has an order.
  double rank(const Node& node, double lower) const noexcept {
    if (rules_.exact || rules_.order == Order::nearest) return lower;
    const float of_parent = node.parent == kNone ? node.s_star : tree_[node.parent].s_star;
    const double s = static_cast<double>(node.s_star < of_parent ? node.s_star : of_parent);
    if (rules_.order == Order::deviation) return -s;
    constexpr double kLeastDistance = 1e-9;
    return -s / (lower > kLeastDistance ? lower : kLeastDistance);
  }

  void measure(std::uint32_t index) noexcept {
    Node& node = tree_[index];
    const PairState& pair = pair_of(node);
    const Piece& a = piece_a(pair, node);
    const Piece& b = piece_b(pair, node);
    set(node, kMeasured);
    const bool leaves = a.children == 0 && b.children == 0;
    if (!leaves && only_culls(pair, node)) {
      const double certain = probe_.bound(pair, node);
      set_rest(pair, node, certain);
      if (certain >= pair.delta) return forget_contact(node);
      const bool all = rules_.exact;
      allow(node, a.children != 0 && (all || is_free(a)), b.children != 0 && (all || is_free(b)));
      split(index);
    } else {
      measure_metric(index, pair, a, b);
    }
  }

  void measure_metric(std::uint32_t index, const PairState& pair, const Piece& a,
                      const Piece& b) noexcept {
    Node& node = tree_[index];
    const convex::Distance d = probe_.own(pair, node);
    const Detail missing = detail(pair, a, b, d, rules_);
    node.s_star = static_cast<float>(missing.s_star);
    node.excess = static_cast<float>(missing.excess);
    if (rests_apart(pair, node, d)) return forget_contact(node);
    const bool refines = missing.refine_a || missing.refine_b;
    if (d.lower_bound < pair.delta) {
      // Overlap of simplified hulls is no contact: the last one, of an ancestor apart, stands.
      if (!refines || !convex::overlaps(d)) touch(index, pair, a, b, d, !refines);
    } else {
      node.contact = 0;
    }
    if (refines) {
      allow(node, missing.refine_a, missing.refine_b);
      wait_for_split(index);
    } else {
      stopped_.add(node, index);
    }
  }

  /// No contact at this level, and what is below is out of reach altogether.
  bool rests_apart(const PairState& pair, Node& node, const convex::Distance& d) noexcept {
    if (d.lower_bound >= pair.delta && certain_now(pair, node) < pair.delta &&
        probe_.has_tighter(pair, node) && !meter_.out_of_units()) {
      probe_.bound(pair, node);
    }
    const double certain = certain_now(pair, node);
    set_rest(pair, node, d.lower_bound < certain ? d.lower_bound : certain);
    return !is_near(node);
  }

  static void forget_contact(Node& node) noexcept { node.contact = 0; }

  void split(std::uint32_t index) noexcept {
    const PairState& pair = pair_of(tree_[index]);
    const Piece& a = piece_a(pair, tree_[index]);
    const Piece& b = piece_b(pair, tree_[index]);
    const std::uint8_t flags = tree_[index].flags;
    const bool split_a = splits_a(pair, a, b, (flags & kRefineA) != 0, (flags & kRefineB) != 0);
    const Piece& piece = split_a ? a : b;
    if (!tree_.split(index, split_a, piece.first_child, piece.children)) {
      result_.truncated_by_memory = true;
      leave(index, certain_now(pair, tree_[index]) * pair.unit_m);
      return;
    }
    const Node& parent = tree_[index];
    const Vec3d towards_a = direction(pair, parent);
    for (std::uint32_t child = parent.first_child; child != kNone;
         child = tree_[child].next_sibling) {
      Node& c = tree_[child];
      begin(pair, c, certain_now(pair, parent));
      inherit(parent, c);
      if (squared_norm(towards_a) > 0) probe_.seed(pair, c, towards_a);
      wait_if_near(child);
    }
  }

  /// Until it is measured, a child stands where its parent did.
  static void inherit(const Node& parent, Node& child) noexcept {
    child.contact = parent.contact;
    child.witness_a = parent.witness_a;
    child.witness_b = parent.witness_b;
    child.slack = parent.slack;
    child.s_star = parent.s_star;
  }

  /// From b to a at the last query; any where none is known.
  static Vec3d direction(const PairState& pair, const Node& node) noexcept {
    if (node.contact == 0) return vec_cast<double>(node.witness_a);
    const Vec3d on_b =
        pair.b_in_a.rotation * vec_cast<double>(node.witness_b) + pair.b_in_a.translation;
    return static_cast<double>(node.contact) * (vec_cast<double>(node.witness_a) - on_b);
  }

  /// Keeps the contact of two pieces in the node, and reports it where refinement stops here.
  void touch(std::uint32_t index, const PairState& pair, const Piece& a, const Piece& b,
             const convex::Distance& d, bool stops) noexcept {
    Node& node = tree_[index];
    const LeafContact contact =
        leaf_contact(pair, a, b, d, node.own, pair.delta, meter_.queries_left(), *memory_.scratch);
    probe_.charge(contact.queries);
    node.contact = 0;
    if (contact.interrupted) {
      result_.truncated_by_units = true;
      leave_unresolved(certain_now(pair, node) * pair.unit_m, node);
    }
    if (!contact.found) return;
    const bool original = !is_simplified(a) && !is_simplified(b);
    if (original && !contact.interrupted) prove(pair, node, contact.lower_bound);
    if (contact.capped) {
      result_.iteration_cap_met = true;
      const double gap = (contact.distance - contact.lower_bound) * pair.unit_m;
      if (gap > result_.capped_gap_m) result_.capped_gap_m = gap;
    }
    if (contact.distance >= pair.delta) return;
    keep(pair, a, b, contact, node);
    if (stops && !report_.add(pair, node, contact)) unreported(pair, node);
  }

  void unreported(const PairState& pair, const Node& node) noexcept {
    result_.truncated_by_memory = true;
    leave_unresolved(certain_now(pair, node) * pair.unit_m, node);
  }

  void leave_unresolved(double lower_m, const Node& node) noexcept {
    if (lower_m < result_.unresolved_lower_m) result_.unresolved_lower_m = lower_m;
    const PairState& pair = pair_of(node);
    const Piece& a = piece_a(pair, node);
    const Piece& b = piece_b(pair, node);
    const float size = a.radius > b.radius ? a.radius : b.radius;
    const float missing = node.s_star < size ? node.s_star : size;  // free levels have no metric
    if (static_cast<double>(missing) > result_.s_worst)
      result_.s_worst = static_cast<double>(missing);
  }

  /// A node that is not resolved keeps its bound and its last contact, re-measured at the material
  /// points.
  void leave(std::uint32_t index, double lower_m) noexcept {
    Node& node = tree_[index];
    const PairState& pair = pair_of(node);
    leave_unresolved(lower_m, node);
    if (node.contact == 0) return;
    const LeafContact contact = remeasured(pair, node);
    if (contact.found && contact.distance < pair.delta && !report_.add(pair, node, contact))
      unreported(pair, node);
  }

  void settle() noexcept {
    for (const Waiting& item : waiting_.items()) leave(item.node, item.lower_m);
  }

  /// Stopped nodes stand for original surface that is somewhere within their bounds.
  QueryResult finish() noexcept {
    for (const std::uint32_t index : stopped_.all()) {
      const Node& node = tree_[index];
      if (tree_.in_front(index) && is_approximate(node))
        leave_unresolved(certain_now(pair_of(node), node) * pair_of(node).unit_m, node);
    }
    report_.finish(result_);
    result_.queries = probe_.queries();
    result_.iteration_cap_met |= probe_.iteration_cap_met();
    return result_;
  }

  bool is_approximate(const Node& node) noexcept {
    const PairState& pair = pair_of(node);
    return is_simplified(piece_a(pair, node)) || is_simplified(piece_b(pair, node));
  }

  std::uint64_t spare_queries() const noexcept {
    return probe_.queries() + kSpareQueries + probe_.queries() / kSpareQueryShare;
  }

  bool out_of_budget() const noexcept { return meter_.out_of_units() || meter_.out_of_time(); }

  /// A parent all of whose children rest takes their place, so that the front does not grow for
  /// ever. Looks at a part of the front a tick, in turn.
  void raise() noexcept {
    const std::uint64_t end = spare_queries();
    const std::size_t scan = kRaiseScan + tree_.front().size() / kRaiseScanShare;
    for (std::size_t i = 0; i < scan && probe_.queries() < end; ++i) {
      if (out_of_budget()) return;
      if (memory_.raise_next >= tree_.front().size()) memory_.raise_next = 0;
      const std::uint32_t parent = tree_[tree_.front()[memory_.raise_next++]].parent;
      if (parent != kNone && children_rest(parent) && rests(parent)) {
        tree_.collapse(parent);
        tree_[parent].contact = 0;
        clear(tree_[parent], kOfThisTick);
      } else if (parent != kNone) {
        renew_detail(tree_[parent]);
      }
    }
  }

  /// What a parent misses is looked at again, in case that it would stop by now (interpolate.hpp).
  void renew_detail(Node& node) noexcept {
    const PairState& pair = pair_of(node);
    if (!rules_.interpolate || only_culls(pair, node) || !is_near(node) || out_of_budget()) return;
    const convex::Distance d = probe_.own(pair, node);
    node.excess = static_cast<float>(
        detail(pair, piece_a(pair, node), piece_b(pair, node), d, rules_).excess);
  }

  bool children_rest(std::uint32_t parent) noexcept {
    for (std::uint32_t c = tree_[parent].first_child; c != kNone; c = tree_[c].next_sibling) {
      if (!tree_.in_front(c) || is_near(tree_[c])) return false;
    }
    return true;
  }

  bool rests(std::uint32_t index) noexcept {
    Node& node = tree_[index];
    PairState& pair = pair_of(node);
    if (!is_near(node)) return true;
    if (!only_culls(pair, node)) return rests_apart(pair, node, probe_.own(pair, node));
    const double certain = probe_.bound(pair, node);
    set_rest(pair, node, certain);
    return certain >= pair.delta;
  }

  /// The least lower bound of a stopped node sets the certificate: the culling hulls may prove more
  /// than h does.
  void tighten() noexcept {
    if (rules_.exact || rules_.bounds == Bounds::paper) return;
    for (const std::uint32_t index : stopped_.all()) {
      const Node& node = tree_[index];
      const PairState& pair = pair_of(node);
      if (!tree_.in_front(index) || !probe_.has_tighter(pair, node)) continue;
      const double certain_m = certain_now(pair, node) * pair.unit_m;
      waiting_.push({certain_m, certain_m, index, false});
    }
    const std::uint64_t end = spare_queries();
    while (!waiting_.empty() && probe_.queries() < end && !out_of_budget()) {
      const std::uint32_t index = waiting_.top().node;
      waiting_.pop();
      Node& node = tree_[index];
      probe_.bound(pair_of(node), node);
    }
    waiting_.clear();
  }

  QueryMemory& memory_;
  TestTree& tree_;
  const Rules& rules_;
  Meter& meter_;
  Probe probe_;
  Report report_;
  WaitQueue waiting_;
  Stopped stopped_;
  QueryResult result_{.unresolved_lower_m = kInfinity};
};

}  // namespace

QueryResult query(QueryMemory& memory, const Rules& rules, Meter& meter) noexcept {
  return Query(memory, rules, meter).run();
}

}  // namespace palpate::levels
