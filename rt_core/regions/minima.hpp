// SPDX-License-Identifier: Apache-2.0
// All contacts of a pair: the least distance of every region of a from b, where that is below
// delta, each proved.
//
// Beyond the paper; docs/DESIGN.md gives the reasons. A search for the force (contact_search.hpp)
// learns from them which edges touch.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base/tally.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/region_state.hpp"
#include "rt_core/regions/search.hpp"
#include "rt_core/regions/sweep.hpp"

namespace palpate::regions {

/// An interval that is no wider, in units, is closed: rounding leaves as much.
inline constexpr float kClosed = 2 * kRounding;

/// A region that may be nearer than delta in this tick.
struct Active {
  float rest = 0;   ///< at the present poses
  float moved = 0;  ///< since the proof, at most
  float width = 0;  ///< min(witness, delta) - rest: what is open of its distance
  Way way;          ///< of the witness as this tick has found it
  std::uint32_t state = 0;
  std::uint32_t region = 0;
  std::uint32_t pair = 0;
};

/// Memory of the query, borrowed from the engine.
struct MinimaMemory {
  const Kernels* kernels = nullptr;
  std::span<levels::PairState> pairs;
  std::span<PairFrame> frames;           ///< [pairs]
  std::span<std::uint32_t> first_state;  ///< [pairs], into states
  std::span<RegionState> states;         ///< [sum over pairs of the regions of a]
  /// [states] The nearest pair known of each region. Its distance is of the last tick in which the
  /// region was active: of a contact exact, else perhaps a bound from below that is no less than
  /// delta. Apart from the states, because it is all of them that most stages ask for.
  std::span<Witness> witnesses;
  std::span<RegionPairs> kept;     ///< [states]
  std::span<Active> active;        ///< [states], those of a tick in the order of their states
  std::span<std::uint32_t> queue;  ///< [states]
  std::span<float> swept;          ///< [most regions of one body]
  std::span<Contact> contacts;     ///< [limits.contacts]
  std::span<std::uint32_t> edges;  ///< [states] of each contact: the edge of a, in its
                                   ///< surface_edges, on which its point lies, where b's lies on an
                                   ///< edge too; else kNone
  /// [states] A bound of each region's distance and most_way_of() when it held, added: what is left
  /// of it tells far regions without their states.
  std::span<double> lasting;
  SearchScratch* search = nullptr;
};

/// What a query found.
struct MinimaResult {
  std::uint32_t contacts = 0;     ///< the first ones of MinimaMemory::contacts
  double min_distance_m = 0;      ///< least over contacts; infinity without contacts
  double unresolved_lower_m = 0;  ///< least lower bound of a region that may be nearer than delta;
                                  ///< infinity where there is none
  double s_worst = 0;             ///< largest radius of a region that is not resolved, relative
  std::uint64_t near_regions = 0;
  bool truncated_by_time = false;
  bool truncated_by_units = false;
  bool truncated_by_memory = false;
};

/// The least distance of every region of a from b that is below delta, for all pairs, whose poses
/// and deltas are set.
///
/// Regions whose lower bound, less the motion since it was proved, is delta or more cost nothing.
/// The witnesses of the others, and those of the pairs kept of them that may be nearer, are
/// measured at the present poses and bound the distances from above. That is exact for as long as
/// no other pair can have come as near; then the region is searched again (search.hpp), the widest
/// interval first. After a jump a sweep of both trees tells what is far. Whatever ends it, every
/// interval holds its distance, and every witness nearer than delta is a contact. Its distance is
/// negative where a's point is inside b, and 0 where the surfaces cross: how deep they do is for
/// contact_search.hpp.
///
/// A contact's pieces are those of level 0 that hold the witnesses. Counts go to the tally. Cost:
/// the budget, plus O(regions), plus one witness of each near region.
MinimaResult find_minima(MinimaMemory& memory, Meter& meter, Tally& tally) noexcept;

}  // namespace palpate::regions
