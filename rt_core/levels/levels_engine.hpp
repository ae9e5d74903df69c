// SPDX-License-Identifier: Apache-2.0
// The paper's contact query (Sec. 5): refinement of the bounding volume test tree, nearest first,
// inside a budget.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/meter.hpp"
#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/levels/test_tree.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::levels {

/// A node waiting for its query, keyed by the proved lower bound of its distance in metres.
struct Waiting {
  double key_m = 0;
  std::uint32_t node = 0;
};

/// Memory of the query, borrowed from the engine.
struct QueryMemory {
  std::span<PairState> pairs;
  TestTree tree;
  std::span<Waiting> waiting;   ///< [nodes]
  std::span<Contact> contacts;  ///< [limits.contacts]
  convex::PenetrationScratch* scratch = nullptr;
  std::size_t raise_next = 0;  ///< where in the front raising goes on
};

/// What a query found.
struct QueryResult {
  std::uint32_t contacts = 0;  ///< the first ones of QueryMemory::contacts
  double min_distance_m = 0;   ///< least over contacts; meaningless without contacts
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
/// Starts from last tick's front (generalised front tracking). Front nodes whose lower bound, less
/// the motion since it was proved, is still delta or more are skipped. The others wait in one queue
/// over all pairs; the nearest is queried first: at delta or more it rests; two leaves give a
/// contact; else it is split into all pairs of its coarser piece's children. What still waits when
/// the budget ends keeps its lower bound, and its contact of last tick, re-measured at its material
/// points. Afterwards the front is raised where all children of a node rest. Departures: nearest
/// first instead of depth first, so that a truncated answer is best where force is largest; hulls
/// above the original surface enclose their descendants, so that eq. 5 holds with h = 0. Cost: the
/// budget, plus one leaf contact, plus O(front).
QueryResult query(QueryMemory& memory, Meter& meter) noexcept;

}  // namespace palpate::levels
