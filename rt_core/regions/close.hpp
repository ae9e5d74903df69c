// SPDX-License-Identifier: Apache-2.0
// One region's interval made narrower.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Searches a region until its interval is closed, or the budget ends. Cost: search().
void close(Work& work, Active& item) noexcept;

}  // namespace palpate::regions
