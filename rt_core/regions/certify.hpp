// SPDX-License-Identifier: Apache-2.0
// What a query has left open.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Sets unresolved_lower_m, to 0 where one body may be inside the other, and s_worst of the result,
/// and adds to its open_m: open intervals, what detail that was left out of the bodies may hide,
/// and what is known but not felt (crowd.hpp). O(active)
void certify(Work& work) noexcept;

}  // namespace palpate::regions
