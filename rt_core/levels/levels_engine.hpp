// SPDX-License-Identifier: Apache-2.0
// The paper's contact query (Sec. 5): sensation preserving refinement of the bounding volume test
// tree inside a budget.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/meter.hpp"
#include "rt_core/base/tally.hpp"
#include "rt_core/convex/penetration.hpp"
#include "rt_core/convex/pressure.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/levels/rules.hpp"
#include "rt_core/levels/test_tree.hpp"
#include "rt_core/levels/waiting.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::levels {

/// Memory of the query, borrowed from the engine.
struct QueryMemory {
  std::span<PairState> pairs;
  TestTree tree;
  std::span<Waiting> waiting;        ///< [nodes]
  std::span<std::uint32_t> stopped;  ///< [nodes]; those that refinement stopped at in this tick
  std::span<Contact> contacts;       ///< [limits.contacts]
  convex::PenetrationScratch* scratch = nullptr;
  convex::PressureScratch* pressure = nullptr;
  std::size_t raise_next = 0;  ///< where in the front raising goes on
  std::uint64_t query_ns = 0;  ///< time of a query, smoothed; 0 without a clock
  bool short_of_room = false;  ///< the last exact query without a budget did not fit
};

/// What a query found.
struct QueryResult {
  std::uint32_t contacts = 0;  ///< the first ones of QueryMemory::contacts
  double min_distance_m = 0;   ///< least over contacts; infinity without contacts
  double upper_m = 0;  ///< the true least distance is at most this; infinity without contacts
  double unresolved_lower_m =
      0;  ///< least lower bound over what was not resolved; infinity where all was
  double capped_gap_m = 0;  ///< widest interval left by an iteration cap
  double s_worst = 0;
  std::uint64_t queries = 0;
  bool truncated_by_time = false;
  bool truncated_by_units = false;
  bool truncated_by_memory = false;
  bool iteration_cap_met = false;
};

/// Q(A, B, delta) for all pairs, whose poses and deltas are set.
///
/// Stage by stage: start (start.hpp) from last tick's front, the near nodes of it on a queue;
/// refine (refine.hpp) while the budget lasts; with time left, keep up the tree and the certificate
/// (upkeep.hpp). What still waits when the budget ends keeps its lower bound, and the last contact
/// that it or an ancestor gave, re-measured at its material points: the cut is complete at every
/// moment, and a truncated answer loses detail only. An exact query that no budget can end is
/// worked off in the cheapest order (Schedule::exhaustive); where its nodes or contacts turn out
/// not to fit, it begins again from the roots, by worth, so that what is nearest gets the memory,
/// and later ticks go on from there until one fits. Departure: nearest first within what has to be
/// measured anyway, so that forces are renewed before detail is added. Cost: the budget, plus one
/// leaf contact, plus O(front).
QueryResult query(QueryMemory& memory, const Rules& rules, Meter& meter, Tally& tally) noexcept;

}  // namespace palpate::levels
