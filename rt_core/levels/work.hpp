// SPDX-License-Identifier: Apache-2.0
// What the stages of one query share: start, refine, upkeep.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/levels/levels_engine.hpp"
#include "rt_core/levels/probe.hpp"
#include "rt_core/levels/report.hpp"
#include "rt_core/levels/stopped.hpp"
#include "rt_core/levels/waiting.hpp"

namespace palpate::levels {

struct Work {
  Work(QueryMemory& query_memory, const Rules& query_rules, Meter& query_meter, Tally& query_tally,
       Schedule schedule) noexcept
      : memory(query_memory),
        tree(query_memory.tree),
        rules(query_rules),
        meter(query_meter),
        tally(query_tally),
        may_end(query_rules.exact ? schedule == Schedule::by_priority : query_meter.limited()),
        probe(query_rules, query_meter, query_tally, schedule),
        report(query_memory.contacts, *query_memory.pressure),
        waiting(query_memory.waiting, schedule),
        stopped(query_memory.stopped) {}

  [[nodiscard]] PairState& pair_of(const Node& node) const noexcept {
    return memory.pairs[node.pair];
  }
  [[nodiscard]] bool is_near(const Node& node) const noexcept {
    return levels::is_near(pair_of(node), node);
  }
  [[nodiscard]] double certified_m(const Node& node) const noexcept {
    const PairState& pair = pair_of(node);
    return certified_now(pair, node) * pair.unit_m;
  }
  [[nodiscard]] bool out_of_budget() const noexcept {
    return meter.out_of_units() || meter.out_of_time();
  }

  /// Gives no contact itself, but has to be split wherever it is near. In an exact query that may
  /// end simplified pieces give one: it stands in for what is below them.
  [[nodiscard]] bool only_culls(const Node& node) const noexcept;

  /// Measures a node that is near: true where it and what is below it give no contact at the
  /// present poses. A query or two.
  bool proves_far(Node& node) noexcept;

  /// The same with the query of its own hulls at hand.
  bool proves_far(Node& node, const convex::Distance& own) noexcept;

  /// Puts something on the queue. Should the budget end before its turn, the contact that it keeps
  /// is reported: time is left for that, too.
  void wait(Waiting item) noexcept;

  /// Takes the first one off the queue.
  [[nodiscard]] std::uint32_t next() noexcept;

  /// For those reported, and those that what waits keeps.
  void leave_time_for_contacts() noexcept;

  /// Notes what is not resolved, for the certificate.
  void leave_unresolved(double lower_m, const Node& node) noexcept;

  /// A node that is not resolved keeps its bound and its last contact, re-measured at the material
  /// points.
  void leave(std::uint32_t index, double lower_m) noexcept;

  /// What is left after all nodes: a doubtful contact where its bodies have none.
  void leave_doubtful(std::uint32_t index) noexcept;

  /// Notes an iteration cap met by a contact of original pieces, for the certificate.
  void note_cap(const PairState& pair, const LeafContact& contact) noexcept;

  /// Reports the contact of a node, once a tick, if it is nearer than delta; or that there was no
  /// room for it.
  void add_contact(Node& node, const LeafContact& contact) noexcept;

  QueryMemory& memory;
  TestTree& tree;
  const Rules& rules;
  Meter& meter;
  Tally& tally;
  bool may_end;  ///< by its budget, or an exact query by its memory
  Probe probe;
  Report report;
  WaitQueue waiting;
  Stopped stopped;
  std::uint32_t kept = 0;  ///< contacts of what waits
  QueryResult result{.unresolved_lower_m = std::numeric_limits<double>::infinity()};
};

}  // namespace palpate::levels
