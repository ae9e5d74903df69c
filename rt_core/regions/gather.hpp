// SPDX-License-Identifier: Apache-2.0
// What of last tick's bounds holds at the present poses.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Sets work.active() to the regions that may be nearer than delta by now, and measures their
/// witnesses and those of their kept pairs that may be nearer. After a jump, when bounds say
/// nothing, one pass over both trees comes first (sweep.hpp). Widths are set.
/// Cost: O(regions); what the pass takes; a sixteenth of a batch for each pair of triangles that is
/// measured, witnesses whatever the budget.
void gather(Work& work) noexcept;

}  // namespace palpate::regions
