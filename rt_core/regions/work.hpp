// SPDX-License-Identifier: Apache-2.0
// The stages of one query of minima, and what they share.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "rt_core/regions/minima.hpp"

namespace palpate::regions {

struct Work {
  Work(MinimaMemory& query_memory, Meter& meter) noexcept : memory(query_memory), pace(meter) {}

  [[nodiscard]] std::span<Active> active() const noexcept { return memory.active.first(count); }
  [[nodiscard]] levels::PairState& pair_of(const Active& item) const noexcept {
    return memory.pairs[item.pair];
  }
  [[nodiscard]] const PairFrame& frame_of(const Active& item) const noexcept {
    return memory.frames[item.pair];
  }
  [[nodiscard]] RegionState& state_of(const Active& item) const noexcept {
    return memory.states[item.state];
  }
  [[nodiscard]] RegionPairs& kept_of(const Active& item) const noexcept {
    return memory.kept[item.state];
  }
  [[nodiscard]] Witness& witness_of(const Active& item) const noexcept {
    return memory.witnesses[item.state];
  }
  [[nodiscard]] float delta_of(const Active& item) const noexcept {
    return static_cast<float>(pair_of(item).delta);
  }
  /// min(witness, delta)
  [[nodiscard]] float upper_of(const Active& item) const noexcept {
    return is_contact(item) ? witness_of(item).distance : delta_of(item);
  }
  [[nodiscard]] bool is_contact(const Active& item) const noexcept {
    return witness_of(item).nearer_than(delta_of(item));
  }
  /// In this tick, of what a search of it meets: it would not last.
  [[nodiscard]] bool keeps_nothing(const Active& item) const noexcept {
    return state_of(item).bare_searches > 0;
  }
  /// A region whose bounds have changed.
  void widen(Active& item) const noexcept {
    const float upper = upper_of(item);
    item.width = upper > item.rest ? upper - (item.rest > 0 ? item.rest : 0) : 0;
  }

  MinimaMemory& memory;
  Pace pace;
  std::uint32_t count = 0;     ///< of active regions
  std::uint32_t searches = 0;  ///< of whole regions, completed
  bool swept = false;          ///< nothing was known when the tick began (sweep.hpp)
  MinimaResult result{.min_distance_m = std::numeric_limits<double>::infinity(),
                      .unresolved_lower_m = std::numeric_limits<double>::infinity()};
};

// The stages, in their order.

/// Sets work.active() to the regions that may be nearer than delta by now, and measures their
/// witnesses and those of their kept pairs that may be nearer. After a jump, when bounds say
/// nothing, one pass over both trees comes first (sweep.hpp). Widths are set.
/// Cost: O(regions); what the pass takes; a sixteenth of a batch for each pair of triangles that is
/// measured, witnesses whatever the budget.
void gather(Work& work) noexcept;

/// Measures those of the kept pairs that may be nearer than their region's witness now, which they
/// replace where they are. That they are not is known of most: by how far they were apart and how
/// the bodies have moved since; and along the way from the witness's one point to the other, where
/// triangles that share its corner or its edge are as far apart as it and no nearer.
///
/// Where the budget ends this, they count as not kept.
/// Precondition: witnesses are measured. Cost: at most half of a budget; kBatchUnits for sixteen
/// pairs that are measured, kSeparationUnits for sixteen that are looked at along a way
void measure_kept(Work& work) noexcept;

/// Searches a region until its interval is closed, or the budget ends. Cost: search().
void close(Work& work, Active& item) noexcept;

/// Appends a contact to work.memory.contacts for every active region whose witness, measured at the
/// present poses, is nearer than delta: closest points, normal, and their distance, negative where
/// that of a is inside b, 0 where the triangles cross.
///
/// Witnesses are placed in double and compared relative to the pair, sixteen at a time. O(active)
void report(Work& work) noexcept;

}  // namespace palpate::regions
