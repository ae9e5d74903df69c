// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/dive.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One search below one node.
class Search {
 public:
  Search(Work& work, const Node& top) noexcept
      : work_(work),
        top_(top),
        pair_(work.pair_of(top)),
        reach_(pair_.delta),
        end_(work.probe.queries() + kMaxDiveQueries) {}

  /// Nothing from `distance` on is of interest.
  void limit(double distance) noexcept {
    if (distance < reach_) reach_ = distance;
  }

  /// The contact of two original pieces. One query, or those of open patches.
  void measure_leaf(std::uint32_t a, std::uint32_t b) noexcept {
    Node leaf = node_of(a, b);
    const convex::Distance d = work_.probe.own(pair_, leaf);
    const bool original =
        !is_simplified(piece_a(pair_, leaf)) && !is_simplified(piece_b(pair_, leaf));
    if (!original) lower(certain_now(pair_, leaf));  // the image holds nothing finer
    if (d.lower_bound >= reach_) return;
    const LeafContact contact =
        leaf_contact(pair_, piece_a(pair_, leaf), piece_b(pair_, leaf), d, leaf.own, reach_,
                     work_.meter.queries_left(), *work_.memory.scratch);
    work_.probe.charge_parts(contact.queries);
    if (contact.interrupted) complete_ = false;
    // A witness on a virtual face gives no contact now, but may slide off that face.
    if (!contact.found) return lower(d.lower_bound);
    if (original) lower(contact.lower_bound);
    if (contact.distance >= reach_) return;
    best_ = contact;
    leaf_a_ = a;
    leaf_b_ = b;
    reach_ = contact.distance;
  }

  /// Depth first, until all that is open cannot matter.
  void run() noexcept {
    complete_ = true;
    if (is_leaf(top_.piece_a, top_.piece_b)) {
      measure_leaf(top_.piece_a, top_.piece_b);
    } else {
      work_.memory.open[size_++] = {top_.piece_a, top_.piece_b, -kInfinity};
    }
    while (size_ > 0) {
      if (work_.probe.queries() >= end_ || work_.out_of_budget()) break;
      const OpenPair next = work_.memory.open[--size_];
      if (next.lower < wanted()) expand(next);
    }
    if (size_ > 0) complete_ = false;
  }

  [[nodiscard]] bool found() const noexcept { return best_.found; }
  [[nodiscard]] const LeafContact& contact() const noexcept { return best_; }

  /// Nothing below the node is nearer than proved(), where the search has come to its end.
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  [[nodiscard]] double proved() const noexcept { return lowest_ < wanted() ? lowest_ : wanted(); }

  void keep_in(Node& node) const noexcept {
    keep(pair_, pair_.image_a->pieces[leaf_a_], pair_.image_b->pieces[leaf_b_], best_, node);
    node.leaf_a = leaf_a_;
    node.leaf_b = leaf_b_;
  }

 private:
  /// Only what is nearer is searched.
  [[nodiscard]] double wanted() const noexcept { return reach_ - kDiveTight * pair_.delta; }

  void lower(double bound) noexcept {
    if (bound < lowest_) lowest_ = bound;
  }

  [[nodiscard]] Node node_of(std::uint32_t a, std::uint32_t b) const noexcept {
    Node node;
    node.pair = top_.pair;
    node.piece_a = a;
    node.piece_b = b;
    node.normal = top_.normal;
    begin(pair_, node, -kInfinity);
    return node;
  }

  [[nodiscard]] bool is_leaf(std::uint32_t a, std::uint32_t b) const noexcept {
    return pair_.image_a->pieces[a].children == 0 && pair_.image_b->pieces[b].children == 0;
  }

  [[nodiscard]] double lower_bound(std::uint32_t a, std::uint32_t b) noexcept {
    Node node = node_of(a, b);
    static_cast<void>(work_.probe.cull(pair_, node));
    return certain_now(pair_, node);
  }

  /// The larger piece gives way to its children. Those that are left are opened so that the nearest
  /// is next.
  void expand(const OpenPair& from) noexcept {
    const Piece& a = pair_.image_a->pieces[from.a];
    const Piece& b = pair_.image_b->pieces[from.b];
    const bool larger_a = pair_.scale_a * static_cast<double>(a.radius) >=
                          pair_.scale_b * static_cast<double>(b.radius);
    const bool split_a = a.children != 0 && (b.children == 0 || larger_a);
    const Piece& parent = split_a ? a : b;
    const std::uint32_t first = size_;
    for (std::uint32_t c = 0; c < parent.children; ++c) {
      const std::uint32_t child = parent.first_child + c;
      visit(split_a ? child : from.a, split_a ? from.b : child, first);
    }
  }

  void visit(std::uint32_t a, std::uint32_t b, std::uint32_t first) noexcept {
    const Piece& of_a = pair_.image_a->pieces[a];
    const Piece& of_b = pair_.image_b->pieces[b];
    if (sphere_distance(pair_, of_a, of_b) >= wanted()) return;
    if (work_.probe.queries() >= end_ || work_.out_of_budget()) {
      complete_ = false;
    } else if (is_leaf(a, b)) {
      measure_leaf(a, b);
    } else {
      open({a, b, lower_bound(a, b)}, first);
    }
  }

  void open(const OpenPair& item, std::uint32_t first) noexcept {
    if (item.lower >= wanted()) return;
    if (size_ == kMaxOpenPairs) {
      complete_ = false;
      return;
    }
    std::uint32_t hole = size_++;
    for (; hole > first && work_.memory.open[hole - 1].lower < item.lower; --hole)
      work_.memory.open[hole] = work_.memory.open[hole - 1];
    work_.memory.open[hole] = item;
  }

  Work& work_;
  const Node& top_;
  const PairState& pair_;
  double reach_;
  double lowest_ = kInfinity;  ///< over the leaves met
  std::uint64_t end_;
  LeafContact best_;
  std::uint32_t leaf_a_ = kNone;
  std::uint32_t leaf_b_ = kNone;
  bool complete_ = false;
  std::uint32_t size_ = 0;
};

/// Keeps what a search has found and proved, and reports it.
void conclude(Work& work, Node& node, const Search& search) noexcept {
  const PairState& pair = work.pair_of(node);
  if (search.complete()) prove(pair, node, search.proved());
  if (search.found()) {
    search.keep_in(node);
    work.note_cap(pair, search.contact());
    if ((node.flags & kStopped) != 0) work.add_contact(node, search.contact());
  } else if (search.complete() && !has_dived(node)) {
    node.contact = 0;  // that of the simplified pieces is none
  }
}

/// Nothing below the node is nearer than what it keeps, or delta, by more than kDiveLoose.
bool is_known(const PairState& pair, const Node& node) noexcept {
  const double known = has_dived(node) ? remeasured(pair, node).distance : pair.delta;
  return certain_now(pair, node) >= known - kDiveLoose * pair.delta;
}

/// The contact of the last tick's pieces, else of those that a search finds.
void find(Work& work, Node& node) noexcept {
  set(node, kDived);
  if (!has_dived(node) && is_known(work.pair_of(node), node)) {
    node.contact = 0;
    return;
  }
  Search search(work, node);
  if (has_dived(node)) search.measure_leaf(node.leaf_a, node.leaf_b);
  if (!search.found()) {
    search.run();
    if (search.complete()) node.contact = 0;
  }
  conclude(work, node, search);
}

/// Searches for a nearer one, unless what is kept will do.
void improve(Work& work, Node& node) noexcept {
  if (is_known(work.pair_of(node), node)) return;
  Search search(work, node);
  if (has_dived(node)) search.limit(remeasured(work.pair_of(node), node).distance);
  search.run();
  conclude(work, node, search);
}

/// Calls a function with every node that may dive, while the budget lasts.
template <class Visit>
void for_each(Work& work, Visit visit) noexcept {
  for (const std::uint32_t index : work.stopped.all()) {
    if (work.out_of_budget()) return;
    if (work.tree.in_front(index) && work.dives(work.tree[index])) visit(work.tree[index]);
  }
  for (const Waiting& item : work.waiting.items()) {
    if (work.out_of_budget()) return;
    visit(work.tree[item.node]);
  }
}

}  // namespace

void dive(Work& work) noexcept {
  if (!work.rules.contact_dive || work.rules.exact) return;
  for_each(work, [&](Node& node) {
    if ((node.flags & kDived) == 0) find(work, node);
  });
  for_each(work, [&](Node& node) {
    if ((node.flags & kDived) != 0) improve(work, node);
  });
}

void report_undived(Work& work) noexcept {
  for (const std::uint32_t index : work.stopped.all()) {
    Node& node = work.tree[index];
    if (!work.tree.in_front(index) || !work.dives(node)) continue;
    if (node.report == kNone && node.contact != 0)
      work.add_contact(node, remeasured(work.pair_of(node), node));
  }
}

void gather(Work& work, std::uint32_t parent) noexcept {
  Node& above = work.tree[parent];
  const PairState& pair = work.pair_of(above);
  double nearest = kInfinity;
  double certain = kInfinity;
  above.contact = 0;
  for (std::uint32_t c = above.first_child; c != kNone; c = work.tree[c].next_sibling) {
    const Node& child = work.tree[c];
    const double of_child = certain_now(pair, child);
    if (of_child < certain) certain = of_child;
    if (child.contact == 0 || child.report == kNone) continue;
    const double distance = remeasured(pair, child).distance;
    if (distance >= nearest) continue;
    nearest = distance;
    hand_over(child, above);
  }
  prove(pair, above, certain);
}

}  // namespace palpate::levels
