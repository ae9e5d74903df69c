// SPDX-License-Identifier: Apache-2.0
// One region's interval made narrower.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Moves the witness to the nearest of its neighbours. Cost and out_beside: climb().
void climb_from_witness(Work& work, Active& item, Beside* out_beside = nullptr) noexcept;

/// Searches a region until its interval is at most `tolerance` (units) wide, or the budget ends:
/// then work.truncated. Cost: search().
void close(Work& work, Active& item, float tolerance) noexcept;

/// The same until any pair nearer than delta is known, or that there is none.
void search_for_any(Work& work, Active& item) noexcept;

/// As close() of a region whose search was left unfinished (unfinished.hpp), from there on and as
/// far as one step goes, after a climb.
void take_up(Work& work, Active& item, float tolerance) noexcept;

/// One step towards that under a budget that may end any moment, the cheap ones first: a witness is
/// sought, then moved to the nearest of its neighbours, then the region is searched, by and by.
/// @param at_once  not by and by
void step(Work& work, Active& item, float tolerance, bool at_once) noexcept;

}  // namespace palpate::regions
