// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/levels_engine.hpp"

#include <limits>

#include "rt_core/base/queue.hpp"
#include "rt_core/levels/leaf_contact.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

/// Rounding of the odometers and of float bounds, in units.
constexpr double kMotionSlack = 1e-9;
/// A query may stop once the pair is this many ticks of the present motion farther than delta: it
/// then rests for as long.
constexpr double kRestTicks = 6;
/// A move by more than this share of the radius (or of delta, where that is more) starts from the
/// roots: an old front says nothing about a far pose.
constexpr double kJumpRadius = 0.05;
constexpr double kJumpDelta = 2;
/// Raising looks at this many front nodes a tick, plus this share of them, and spends at most so
/// many queries.
constexpr std::uint32_t kRaiseScan = 64;
constexpr std::uint32_t kRaiseScanShare = 32;
constexpr std::uint64_t kRaiseQueries = 16;
constexpr std::uint64_t kRaiseQueryShare = 8;

struct Nearer {
  bool operator()(const Waiting& a, const Waiting& b) const noexcept {
    return a.key_m < b.key_m || (a.key_m == b.key_m && a.node < b.node);
  }
};
using WaitQueue = MinQueue<Waiting, Nearer>;

const Piece& piece_a(const PairState& pair, const Node& node) noexcept {
  return pair.image_a->pieces[node.piece_a];
}
const Piece& piece_b(const PairState& pair, const Node& node) noexcept {
  return pair.image_b->pieces[node.piece_b];
}

/// Lower bound now: the proved one less what a's points can have moved since.
double lower_now(const PairState& pair, const Node& node) noexcept {
  return static_cast<double>(node.lower) - (pair.travel - node.travel_at) -
         (pair.turn - node.turn_at) * static_cast<double>(node.reach) - kMotionSlack;
}

/// Rounded towards minus infinity far enough for float.
float float_below(double v) noexcept { return static_cast<float>(v - 1e-7 * (v < 0 ? -v : v)); }

void prove(const PairState& pair, Node& node, double lower) noexcept {
  node.lower = float_below(lower);
  node.travel_at = pair.travel;
  node.turn_at = pair.turn;
}

/// First bound of a node that has none: its spheres, or what its parent has proved.
void begin(const PairState& pair, Node& node, double inherited) noexcept {
  const Piece& a = piece_a(pair, node);
  const double reach =
      norm(centre_of(a, pair.scale_a)) + pair.scale_a * static_cast<double>(a.radius);
  node.reach = static_cast<float>(reach * (1 + 1e-6));
  const double spheres = sphere_distance(pair, a, piece_b(pair, node)) - kMotionSlack;
  prove(pair, node, spheres > inherited ? spheres : inherited);
}

/// The coarser piece is split (Sec. 5.2). Free levels have no resolution and go first; among them,
/// and between levels of equal resolution, the larger piece.
bool splits_a(const PairState& pair, const Piece& a, const Piece& b) noexcept {
  if (a.children == 0 || b.children == 0) return a.children != 0;
  const double child_a =
      static_cast<double>(pair.image_a->pieces[a.first_child].resolution) / pair.scale_a;
  const double child_b =
      static_cast<double>(pair.image_b->pieces[b.first_child].resolution) / pair.scale_b;
  if (child_a != child_b) return child_a < child_b;
  return pair.scale_a * static_cast<double>(a.radius) >=
         pair.scale_b * static_cast<double>(b.radius);
}

class Query {
 public:
  Query(QueryMemory& memory, Meter& meter) noexcept
      : memory_(memory), tree_(memory.tree), meter_(meter), waiting_(memory.waiting) {
    result_.unresolved_lower_m = std::numeric_limits<double>::infinity();
    result_.min_distance_m = std::numeric_limits<double>::infinity();
  }

  QueryResult run() noexcept {
    for (PairState& pair : memory_.pairs) restart_if_far(pair);
    for (const std::uint32_t node : tree_.front()) wait_if_near(node);
    refine();
    if (!result_.truncated_by_time && !result_.truncated_by_units) raise();
    meter_.begin_tail();
    settle();
    return result_;
  }

 private:
  PairState& pair_of(const Node& node) noexcept { return memory_.pairs[node.pair]; }

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
    begin(pair, root, -std::numeric_limits<double>::infinity());
    pair.fresh = false;
  }

  void wait_if_near(std::uint32_t index) noexcept {
    const Node& node = tree_[index];
    const PairState& pair = pair_of(node);
    const double lower = lower_now(pair, node);
    if (lower < pair.delta) waiting_.push({lower * pair.unit_m, index});
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
      visit(index);
    }
  }

  convex::Distance measure(PairState& pair, Node& node) noexcept {
    meter_.charge(1);
    ++result_.queries;
    const double rest =
        kRestTicks * (pair.last_travel + pair.last_turn * static_cast<double>(node.reach));
    const convex::Distance d =
        convex::distance(hull_of(*pair.image_a, piece_a(pair, node), pair.scale_a),
                         hull_of(*pair.image_b, piece_b(pair, node), pair.scale_b), pair.b_in_a,
                         pair.delta + rest, node.cache);
    double lower = d.lower_bound;
    if (d.state == convex::State::penetrating || d.state == convex::State::touching) {
      const double spheres = sphere_distance(pair, piece_a(pair, node), piece_b(pair, node));
      lower = spheres < 0 ? spheres : 0;
    }
    prove(pair, node, lower);
    if (d.state == convex::State::gave_up) result_.iteration_cap_met = true;
    return d;
  }

  void visit(std::uint32_t index) noexcept {
    Node& node = tree_[index];
    PairState& pair = pair_of(node);
    const Piece& a = piece_a(pair, node);
    const Piece& b = piece_b(pair, node);
    const convex::Distance d = measure(pair, node);
    node.contact = 0;
    if (d.lower_bound >= pair.delta) return;
    if (a.children == 0 && b.children == 0) {
      touch(pair, node, a, b, d);
      return;
    }
    const bool split_a = splits_a(pair, a, b);
    const Piece& split = split_a ? a : b;
    if (!tree_.split(index, split_a, split.first_child, split.children)) {
      result_.truncated_by_memory = true;
      leave_unresolved(lower_now(pair, node) * pair.unit_m, a, b);
      return;
    }
    for (std::uint32_t child = tree_[index].first_child; child != kNone;
         child = tree_[child].next_sibling) {
      begin(pair, tree_[child], static_cast<double>(tree_[index].lower));
      if (d.state == convex::State::separated) seed_cache(pair, tree_[child], d.normal);
      wait_if_near(child);
    }
  }

  void seed_cache(const PairState& pair, Node& node, Vec3d normal) noexcept {
    convex::seed(hull_of(*pair.image_a, piece_a(pair, node), pair.scale_a),
                 hull_of(*pair.image_b, piece_b(pair, node), pair.scale_b), pair.b_in_a, normal,
                 node.cache);
  }

  void touch(PairState& pair, Node& node, const Piece& a, const Piece& b,
             const convex::Distance& d) noexcept {
    const LeafContact contact = leaf_contact(pair, a, b, d, node.cache, pair.delta,
                                             meter_.queries_left(), *memory_.scratch);
    meter_.charge(contact.queries);
    result_.queries += contact.queries;
    if (contact.interrupted) {
      result_.truncated_by_units = true;
      leave_unresolved(lower_now(pair, node) * pair.unit_m, a, b);
    }
    if (!contact.found) return;
    if (!contact.interrupted) prove(pair, node, contact.lower_bound);
    if (contact.capped) {
      result_.iteration_cap_met = true;
      const double gap = (contact.distance - contact.lower_bound) * pair.unit_m;
      if (gap > result_.capped_gap_m) result_.capped_gap_m = gap;
    }
    if (contact.distance >= pair.delta) return;
    node.contact = contact.distance < 0 ? -1 : 1;
    node.witness_a = vec_cast<float>(contact.point_a);
    node.witness_b = vec_cast<float>(transpose(pair.b_in_a.rotation) *
                                     (contact.point_b - pair.b_in_a.translation));
    report(pair, node, contact.point_a, contact.point_b, contact.normal, contact.distance);
  }

  void report(const PairState& pair, const Node& node, Vec3d point_a, Vec3d point_b, Vec3d normal,
              double distance) noexcept {
    const double distance_m = distance * pair.unit_m;
    if (result_.contacts == memory_.contacts.size()) {
      result_.truncated_by_memory = true;
      leave_unresolved(distance_m, piece_a(pair, node), piece_b(pair, node));
      return;
    }
    Contact& out = memory_.contacts[result_.contacts++];
    out.point_a_m = pair.centre_a_m + pair.rotation_a * (pair.unit_m * point_a);
    out.point_b_m = pair.centre_a_m + pair.rotation_a * (pair.unit_m * point_b);
    out.normal = pair.rotation_a * normal;
    out.distance_m = distance_m;
    out.weight = 0;
    out.pair = node.pair;
    out.piece_a = node.piece_a;
    out.level_a = piece_a(pair, node).level;
    out.piece_b = node.piece_b;
    out.level_b = piece_b(pair, node).level;
    if (distance_m < result_.min_distance_m) result_.min_distance_m = distance_m;
  }

  void leave_unresolved(double lower_m, const Piece& a, const Piece& b) noexcept {
    if (lower_m < result_.unresolved_lower_m) result_.unresolved_lower_m = lower_m;
    const double size = static_cast<double>(a.radius > b.radius ? a.radius : b.radius);
    if (size > result_.s_worst) result_.s_worst = size;
  }

  /// What still waits: its bound stands, and contacts of last tick are measured again at their
  /// material points.
  void settle() noexcept {
    for (const Waiting& item : waiting_.items()) {
      Node& node = tree_[item.node];
      PairState& pair = pair_of(node);
      leave_unresolved(item.key_m, piece_a(pair, node), piece_b(pair, node));
      if (node.contact == 0) continue;
      const Vec3d on_a = vec_cast<double>(node.witness_a);
      const Vec3d on_b =
          pair.b_in_a.rotation * vec_cast<double>(node.witness_b) + pair.b_in_a.translation;
      const Vec3d apart = on_a - on_b;
      const double sign = node.contact;
      const double gap = norm(apart);
      if (gap > 0 && sign * gap < pair.delta)
        report(pair, node, on_a, on_b, (sign / gap) * apart, sign * gap);
    }
  }

  /// A parent all of whose children rest takes their place, so that the front does not grow for
  /// ever. Looks at a part of the front a tick, in turn.
  void raise() noexcept {
    const std::uint64_t most = kRaiseQueries + result_.queries / kRaiseQueryShare;
    const std::uint64_t end = result_.queries + most;
    const std::size_t scan = kRaiseScan + tree_.front().size() / kRaiseScanShare;
    for (std::size_t i = 0; i < scan && result_.queries < end; ++i) {
      if (meter_.out_of_units() || meter_.out_of_time()) return;
      if (memory_.raise_next >= tree_.front().size()) memory_.raise_next = 0;
      const std::uint32_t parent = tree_[tree_.front()[memory_.raise_next++]].parent;
      if (parent != kNone && children_rest(parent) && rests(parent)) tree_.collapse(parent);
    }
  }

  bool children_rest(std::uint32_t parent) noexcept {
    const PairState& pair = pair_of(tree_[parent]);
    for (std::uint32_t c = tree_[parent].first_child; c != kNone; c = tree_[c].next_sibling) {
      if (!tree_.in_front(c) || lower_now(pair, tree_[c]) < pair.delta) return false;
    }
    return true;
  }

  bool rests(std::uint32_t index) noexcept {
    Node& node = tree_[index];
    PairState& pair = pair_of(node);
    if (lower_now(pair, node) >= pair.delta) return true;
    const double spheres =
        sphere_distance(pair, piece_a(pair, node), piece_b(pair, node)) - kMotionSlack;
    if (spheres >= pair.delta) {
      prove(pair, node, spheres);
      return true;
    }
    return measure(pair, node).lower_bound >= pair.delta;
  }

  QueryMemory& memory_;
  TestTree& tree_;
  Meter& meter_;
  WaitQueue waiting_;
  QueryResult result_;
};

}  // namespace

QueryResult query(QueryMemory& memory, Meter& meter) noexcept { return Query(memory, meter).run(); }

}  // namespace palpate::levels
