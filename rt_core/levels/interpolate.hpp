// SPDX-License-Identifier: Apache-2.0
// LOD interpolation (Sec. 5.5): no jump of the force where refinement moves up or down a level.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/meter.hpp"
#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/probe.hpp"
#include "rt_core/levels/report.hpp"
#include "rt_core/levels/stopped.hpp"
#include "rt_core/levels/test_tree.hpp"

namespace palpate::levels {

/// What interpolation works on, all borrowed from the query.
struct Interpolation {
  std::span<PairState> pairs;
  TestTree& tree;
  const Rules& rules;
  Probe& probe;
  Report& report;
  Stopped& stopped;
  convex::PenetrationScratch& scratch;
  Meter& meter;
  std::uint32_t tick = 0;  ///< marks inner nodes that have been measured
};

/// From this excess of a parent on, its children have all of the contact.
inline constexpr double kOwnContactFrom = 2;

/// Mixes the contacts of front nodes with that of their parent.
///
/// The paper gives no formula. Let e be how far a node's missing detail is above what the rules
/// allow (Detail::excess, 1 at the switch). Where a parent has e_p > 1 and all its near children
/// stopped, the largest of all its children's being e_c <= 1, they have the share
/// (e_p - 1) / (1 - e_c), at most all, of distance, normal and points, and the parent has the rest.
/// At e_p = 1, where refinement would stop at the parent, that is the parent's contact alone; at
/// e_c = 1, where a child would be refined, the children's alone: continuous at both, and where a
/// child comes within delta or leaves it. The parents are what the query has passed through, so the
/// paper's conservative refinement below a stop is not needed. A parent with e_p <= 1 takes its
/// children's place: so the front does not depend on how it came about. One query for each near
/// parent of stopped nodes, or with e_p < kOwnContactFrom, while the budget lasts.
void interpolate(const Interpolation& on) noexcept;

}  // namespace palpate::levels
