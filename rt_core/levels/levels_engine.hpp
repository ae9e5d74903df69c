// SPDX-License-Identifier: Apache-2.0
// The paper's contact query (Sec. 5): sensation preserving refinement of the bounding volume test
// tree inside a budget.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/meter.hpp"
#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/levels/rules.hpp"
#include "rt_core/levels/test_tree.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::levels {

/// A node waiting for its query or, once measured, for its split.
struct Waiting {
  double rank = 0;     ///< less comes first
  double lower_m = 0;  ///< the proved lower bound of its distance in metres
  std::uint32_t node = 0;
  bool later = false;  ///< adds detail: after all that only renews contacts
};

/// Memory of the query, borrowed from the engine.
struct QueryMemory {
  std::span<PairState> pairs;
  TestTree tree;
  std::span<Waiting> waiting;        ///< [nodes]
  std::span<std::uint32_t> stopped;  ///< [nodes]; those that refinement stopped at in this tick
  std::span<Contact> contacts;       ///< [limits.contacts]
  convex::PenetrationScratch* scratch = nullptr;
  std::size_t raise_next = 0;  ///< where in the front raising goes on
  std::uint32_t ticks = 0;     ///< marks inner nodes that interpolation has been to
  std::uint64_t query_ns = 0;  ///< time of a query, smoothed; 0 without a clock
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
/// Starts from last tick's front (generalised front tracking), or higher where the budget would not
/// do for measuring it again. Front nodes whose lower bound, less the motion since it was proved,
/// is still delta or more are skipped. The others are measured, nearest first: at delta or more
/// they rest; where missing detail could be felt (rules.hpp) they wait to be split, in the order of
/// Rules::order over all pairs, free levels first; else they stop and give a contact. A split
/// replaces a node by all pairs of one piece's children, which are measured before the next split.
/// What still waits when the budget ends keeps its lower bound, and the last contact that it or an
/// ancestor gave, re-measured at its material points: the cut is complete at every moment, and a
/// truncated answer loses detail only. With time left, contacts are interpolated between levels
/// (interpolate.hpp), the front is raised where children rest or their parent would stop, and lower
/// bounds of the nearest stops are tightened for the certificate. Departure: nearest first within
/// what has to be measured anyway, so that forces are renewed before detail is added. Cost: the
/// budget, plus one leaf contact, plus O(front).
QueryResult query(QueryMemory& memory, const Rules& rules, Meter& meter) noexcept;

}  // namespace palpate::levels
