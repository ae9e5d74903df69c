// SPDX-License-Identifier: Apache-2.0
// The one queue of a query, over all pairs of bodies: what waits to be measured or split.
#pragma once

#include <cstdint>

#include "rt_core/base/queue.hpp"

namespace palpate::levels {

/// A node waiting for its query or, once measured, for its split.
struct Waiting {
  double rank = 0;     ///< less comes first
  double lower_m = 0;  ///< the proved lower bound of its distance in metres
  std::uint32_t node = 0;
  bool later = false;  ///< adds detail: after all that only renews contacts
};

/// A strict total order: results do not depend on how the queue came about.
struct Earlier {
  bool operator()(const Waiting& a, const Waiting& b) const noexcept {
    if (a.later != b.later) return b.later;
    if (a.rank != b.rank) return a.rank < b.rank;
    return a.lower_m < b.lower_m || (a.lower_m == b.lower_m && a.node < b.node);
  }
};

using WaitQueue = MinQueue<Waiting, Earlier>;

}  // namespace palpate::levels
