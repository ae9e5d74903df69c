// SPDX-License-Identifier: Apache-2.0
// What ticks are made of. Counted where the library is built with PALPATE_COUNTERS (a CMake
// option); else no code and no memory of it is left.
#pragma once

#include <cstdint>

#include "rt_core/palpate_rt.hpp"

namespace palpate {

/// Parts of a tick, in their order.
enum class Stage : std::uint8_t {
  start,   ///< last tick's front; the regions engine's guess of what carries
  refine,  ///< queries and splits; the regions engine's distances and proof
  upkeep,  ///< raising the front, tightening the certificate (levels engine)
  settle,  ///< contacts and bounds of what is not resolved (levels engine)
  force,   ///< contacts into a wrench
};
inline constexpr std::uint32_t kStages = 5;

/// Sums and maxima over ticks.
struct Counters {
  std::uint64_t ticks = 0;
  std::uint64_t stage_ns[kStages] = {};  ///< on the budget's clock; 0 without one
  // Levels engine.
  std::uint64_t own_queries = 0;      ///< of the pieces' own hulls
  std::uint64_t culling_queries = 0;  ///< of culling hulls
  std::uint64_t part_queries = 0;     ///< of triangles of open patches
  std::uint64_t iterations = 0;       ///< support pairs found by own and culling queries
  std::uint64_t warm_queries = 0;     ///< own and culling: answered by one support pair
  std::uint64_t splits = 0;
  // Regions engine.
  std::uint64_t near_regions = 0;  ///< that may have been nearer than delta
  std::uint64_t searches = 0;      ///< of whole regions, completed
  std::uint64_t sweeps = 0;        ///< ticks after a jump: one pass over both trees
  // High-water marks of the pools.
  std::uint32_t most_nodes = 0;     ///< of Limits::nodes
  std::uint32_t most_waiting = 0;   ///< of Limits::nodes
  std::uint32_t most_contacts = 0;  ///< of Limits::contacts
};

/// Since the engine was made or last reset; null where nothing is counted.
[[nodiscard]] const Counters* counters(const Engine& engine) noexcept;

void reset_counters(Engine& engine) noexcept;

}  // namespace palpate
