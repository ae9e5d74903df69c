// SPDX-License-Identifier: Apache-2.0
// Contacts of fast bodies, kept from sliding away.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// In a tick with a budget that does not begin anew (Work::anew), before any search: of bodies so
/// fast that nothing is kept of their regions (motion.hpp) the witnesses climb, nearest first.
/// Where one touches the border of its region, the region beside begins with what was measured
/// there and climbs in its turn, so that a contact is not lost where it passes from one region to
/// the next. Nothing is proved by it. Cost: half of what the tick has left.
void track(Work& work) noexcept;

}  // namespace palpate::regions
