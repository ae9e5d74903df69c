// SPDX-License-Identifier: Apache-2.0
// The second contact query: certified bounds of the distance of every region of a from b, refined
// where they can still change the force most, inside a budget.
//
// Beyond the paper. docs/DESIGN.md gives the reasons; the levels engine answers the same question
// from convex pieces.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/tally.hpp"
#include "rt_core/convex/penetration.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/regions/containment.hpp"
#include "rt_core/regions/crossing.hpp"
#include "rt_core/regions/crowd.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/pursuit.hpp"
#include "rt_core/regions/region_state.hpp"
#include "rt_core/regions/search.hpp"
#include "rt_core/regions/sweep.hpp"
#include "rt_core/regions/unfinished.hpp"
#include "rt_core/regions/ways_out.hpp"

namespace palpate::regions {

/// An interval that is no wider, in units, is closed: rounding leaves as much.
inline constexpr float kClosed = 2 * kRounding;

/// How many contacts take as long as these, when a query has ended: where surfaces cross, pairs of
/// triangles are listed and overlaps of pieces measured.
constexpr std::uint64_t tail_contacts(std::uint64_t contacts, std::uint64_t crossings) noexcept {
  constexpr std::uint64_t kMore = 24;
  return contacts + kMore * crossings;
}

/// A region that may be nearer than delta in this tick.
struct Active {
  float rest = 0;     ///< at the present poses
  float moved = 0;    ///< since the proof, at most
  float width = 0;    ///< min(witness, delta) - rest: what its force may still change by
  float weight = 1;   ///< the root of what a search of it costs, of which the mean is 1
  float lone = 1;     ///< of what is felt, the less else is felt that way the more, 1 in the mean
  float urgency = 0;  ///< the larger, the sooner it is looked at
  Way way;            ///< of the witness as this tick has found it
  std::uint32_t state = 0;
  std::uint32_t region = 0;
  std::uint32_t pair = 0;
  bool climbed = false;  ///< no climb: done, or the witness is certainly not felt
};

/// Room for the ways out of pieces that cross, over all regions; what is beyond is felt whole.
constexpr std::size_t ways_out_for(std::size_t states) noexcept {
  return 2 * states + std::size_t{kMaxCrossings} * kMaxCrossings;
}

/// Memory of the query, borrowed from the engine.
struct QueryMemory {
  const Kernels* kernels = nullptr;
  std::span<levels::PairState> pairs;
  std::span<PairFrame> frames;           ///< [pairs]
  std::span<Containment> containment;    ///< [pairs]
  std::span<std::uint32_t> first_state;  ///< [pairs], into states
  std::span<RegionState> states;         ///< [sum over pairs of the regions of a]
  /// [states] The nearest pair known of each region. Its distance is of the last tick in which the
  /// region was active, or a scout looked at it: of a contact exact, else perhaps a bound from
  /// below that is no less than delta. Apart from the states, because it is all of them that most
  /// stages ask for.
  std::span<Witness> witnesses;
  std::span<RegionPairs> kept;     ///< [states]
  std::span<Active> active;        ///< [states], those of a tick in the order of their states
  std::span<std::uint32_t> queue;  ///< [states]
  std::span<std::uint64_t> turns;  ///< [states]
  std::span<WayOut> ways_out;      ///< [ways_out_for(states)]
  std::span<float> swept;          ///< [most regions of one body]
  std::span<Contact> contacts;     ///< [limits.contacts, no more than states and what is inside]
  /// [states] A bound of each region's distance and most_way_of() when it held, added: what is left
  /// of it tells far regions without their states.
  std::span<double> lasting;
  /// [states] Until most_way_of() is so much a scout does not look at the region again (scout.hpp).
  std::span<double> scouted;
  SearchScratch* search = nullptr;
  CrossingScratch* crossing = nullptr;
  Unfinished* unfinished = nullptr;  ///< from tick to tick
  Pursuit pursuit;                   ///< likewise
  Crowd crowd;                       ///< likewise
};

/// What a query found.
struct QueryResult {
  std::uint32_t contacts = 0;     ///< the first ones of QueryMemory::contacts
  std::uint32_t crossings = 0;    ///< those where surfaces cross
  double min_distance_m = 0;      ///< least over contacts; infinity without contacts
  double unresolved_lower_m = 0;  ///< least lower bound of a region that may be nearer than delta;
                                  ///< infinity where there is none
  double open_m = 0;              ///< sum over regions of min(upper, delta) - lower, of bodies as
                                  ///< they were before detail was left out of them
  double capped_gap_m = 0;        ///< no iteration cap leaves a gap here
  double s_worst = 0;             ///< largest radius of a region that is not resolved, relative
  std::uint64_t near_regions = 0;
  std::uint64_t queries = 0;  ///< work units
  bool maybe_apart = false;   ///< some contact is a depth in a body that may have been left since
  bool truncated_by_time = false;
  bool truncated_by_units = false;
  bool truncated_by_memory = false;
  bool iteration_cap_met = false;
  bool on_reserve = false;  ///< what the budget has in reserve was drawn on
};

/// How far a query goes.
struct Demand {
  double tolerance_m = 0;  ///< the sum of all open intervals may stay this wide where
                           ///< something is felt; 0: exact
  bool limited = false;    ///< there is a budget: what is widest goes first
};

/// The least distance of every region of a from b that is below delta, for all pairs, whose poses
/// and deltas are set.
///
/// Regions whose lower bound, less the motion since it was proved, is delta or more cost nothing.
/// The witnesses of the others, and those of the pairs kept of them that may be nearer, are
/// measured at the present poses and bound the distances from above. That is exact for as long as
/// no other pair can have come as near; then the region is searched again (search.hpp), under a
/// budget the widest interval first and closed in steps, after a cheap look at the witness's
/// neighbours. Witnesses of fast bodies climb before all searches (track.hpp), and where few
/// regions are felt, looks and climbs find what comes near others (watch.hpp). One search that the
/// budget ends goes on in the next tick, before all others (unfinished.hpp). A tolerance is shared
/// so that what costs more to search may stay open wider. A budget that is far too small for the
/// searches goes to following the witnesses instead where that brings them nearer (follow.hpp).
/// After a jump regions are searched as long as the budget seems to do for all; from then on a
/// survey comes first (survey.hpp), and then the deepest contacts, first those that push alone
/// (lone.hpp). So it is for fast bodies with many contacts (Work::anew). Whatever ends it, a tick
/// that feels nothing goes on for a first contact with what the budget has in reserve
/// (reserve.hpp), every interval holds its distance, and every witness nearer than delta is a
/// contact, or as many of them as there is time to report (crowd.hpp). Where triangles cross, the
/// pieces that they belong to give the depth and the curve in which they do the direction
/// (crossing.hpp); for that, at most half of a budget is left. Whether one body is inside the other
/// is asked wherever they may have passed through each other, in as many ticks as the budget takes
/// for it (containment.hpp).
///
/// A contact's pieces are those of level 0 that hold the witnesses. Stages and counts go to the
/// tally. Cost: the budget and its reserve, plus O(regions), plus one witness of each near region.
QueryResult query(QueryMemory& memory, const Demand& demand, Meter& meter, Tally& tally) noexcept;

}  // namespace palpate::regions
