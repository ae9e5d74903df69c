// SPDX-License-Identifier: Apache-2.0
// A tick that its budget leaves without a contact, and without knowing that there is none.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Whether two bodies touch, for every pair that feels nothing and may: out of what the budget has
/// in reserve (Budget::reserve_units), and for nothing else. The nearest places are looked at and
/// searched first (scout.hpp), then what is left of the regions, until one is felt; where none is,
/// whether one body is inside the other, unless that is certain of some component. What has been
/// proved on the way holds in the ticks to come.
///
/// Without a budget, or without a reserve, nothing. Cost: the reserve at most.
void decide_on_reserve(Work& work) noexcept;

}  // namespace palpate::regions
