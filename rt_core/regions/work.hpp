// SPDX-License-Identifier: Apache-2.0
// What the stages of one query of minima share: gather, close, report.
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

}  // namespace palpate::regions
