// SPDX-License-Identifier: Apache-2.0
// Convex queries of the test tree's nodes, and the lower bounds that they prove.
#pragma once

#include <cstdint>

#include "rt_core/base/meter.hpp"
#include "rt_core/base/tally.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/levels/rules.hpp"
#include "rt_core/levels/test_tree.hpp"

namespace palpate::levels {

inline const image::Piece& piece_a(const PairState& pair, const Node& node) noexcept {
  return pair.image_a->pieces[node.piece_a];
}
inline const image::Piece& piece_b(const PairState& pair, const Node& node) noexcept {
  return pair.image_b->pieces[node.piece_b];
}

/// Node::lower_bound and Node::certified now: less what a's points can have moved since they were
/// proved.
double lower_bound_now(const PairState& pair, const Node& node) noexcept;
double certified_now(const PairState& pair, const Node& node) noexcept;

inline bool is_near(const PairState& pair, const Node& node) noexcept {
  return lower_bound_now(pair, node) < pair.delta;
}

/// Takes over a lower bound proved at this tick's pose, unless what is left of the last one is
/// better.
void prove(const PairState& pair, Node& node, double certified) noexcept;

/// Sets Node::lower_bound for this tick's pose.
void set_lower_bound(const PairState& pair, Node& node, double lower_bound) noexcept;

/// First bounds of a node that has none: its spheres, and what is certified of its parent.
void begin(const PairState& pair, Node& node, double inherited) noexcept;

/// What is asked of culling hulls.
enum class Ask : std::uint8_t {
  bound,     ///< how near what they hold can be
  nearness,  ///< whether that is nearer than delta: the bound of a node that is split matters only
             ///< where the query may end before its children are measured
};

/// Does the queries, charges them, and proves the bounds that follow for the original surface.
class Probe {
 public:
  Probe(const Rules& rules, Meter& meter, Tally& tally, Schedule schedule) noexcept
      : rules_(rules), meter_(meter), tally_(tally), schedule_(schedule) {}

  /// Of the culling hulls, exact up to delta and a little more, so that a node stays far for some
  /// ticks. With Bounds::paper of the hulls themselves, widened by h (eq. 5). certified_now() then
  /// has what follows for the original surfaces.
  convex::Distance cull(const PairState& pair, Node& node, Ask ask = Ask::bound) noexcept;

  /// Of the pieces' own hulls, exact up to delta + h + h.
  convex::Distance own(const PairState& pair, Node& node) noexcept;

  /// Would cull() tell more than own() has?
  [[nodiscard]] bool has_tighter(const PairState& pair, const Node& node) const noexcept {
    return rules_.bounds == Bounds::tight &&
           (piece_a(pair, node).culling_vertices != 0 || piece_b(pair, node).culling_vertices != 0);
  }

  /// Charges queries of the parts of open patches.
  void charge_parts(std::uint64_t queries) noexcept {
    charge(queries);
    tally_.count([&](auto& counters) { counters.part_queries += queries; });
  }
  [[nodiscard]] std::uint64_t queries() const noexcept { return queries_; }
  [[nodiscard]] bool iteration_cap_met() const noexcept { return capped_; }

 private:
  void charge(std::uint64_t queries) noexcept {
    meter_.charge(queries);
    queries_ += queries;
  }
  void note(const convex::Distance& d) noexcept;
  [[nodiscard]] double far_margin(const PairState& pair, const Node& node) const noexcept;

  const Rules& rules_;
  Meter& meter_;
  Tally& tally_;
  Schedule schedule_;
  std::uint64_t queries_ = 0;
  bool capped_ = false;
};

}  // namespace palpate::levels
