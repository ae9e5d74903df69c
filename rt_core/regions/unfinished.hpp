// SPDX-License-Identifier: Apache-2.0
// A search that one tick has no time to end goes on in the next.
#pragma once

#include <cstdint>

#include "rt_core/regions/region_state.hpp"
#include "rt_core/regions/search.hpp"

namespace palpate::regions {

/// The one search that is kept so. There is one: of several, none would end.
struct Unfinished {
  std::uint32_t state = image::kNone;  ///< whose, into QueryMemory::states; kNone: there is none
  Stand at;                            ///< where its region stood when it was left
  double spent = 0;                    ///< work units, in all its ticks
  Remainder left;
  [[nodiscard]] bool any() const noexcept { return state != image::kNone; }
  void drop() noexcept { state = image::kNone; }
};

}  // namespace palpate::regions
