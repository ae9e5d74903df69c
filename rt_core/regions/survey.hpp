// SPDX-License-Identifier: Apache-2.0
// First witnesses after a jump, where searches would take many ticks.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Gives active regions that are open a witness by looks (look.hpp): the nearest of some spread
/// over the region, most of them only where the first quarter has met something within two delta,
/// then of half as many beside that. What looks meet is bounded (Kernels::triangle_bounds), and
/// measured only where it may be nearer than what the region has. Rounds of some sixteen regions
/// each follow the order in which they are spread over the surface (image::Region::rank), so that
/// whatever ends it has seen evenly of everywhere: a force is told by few contacts from all sides
/// (crowd.hpp), and told wrong by many from one. Before others begin the first twelve are repeated
/// up to eight times, with other places, until what is left does for searching what is felt. A
/// round begins if there seem to be units and time for all of it. A region has four to sixteen
/// looks in a round, as many as there are units for if 64 are to be seen; fewer, down to ten, if
/// the first twelve rounds are all to be seen and less than three quarters of what has been is
/// felt. In ticks that do not begin anew (Work::anew), goes on where the last survey ended
/// (Pursuit::surveyed), round by round. In those that do, but not after a jump, regions that it
/// does not get to forget their witnesses, unless these cross, their bodies are slow, or nothing of
/// what it has seen of the two is felt.
///
/// Proves nothing; witnesses are at the present poses as before. Where an image cannot be looked up
/// in, nothing. Takes the queue of the query's memory as scratch. Widths and urgencies are to be
/// told anew (Work::widen_all).
/// @param share  of the tick's units and time, within what the budget leaves
/// @return false where no round was begun
/// Cost: the share, plus five passes over all active regions a round, of at most 148, and two to
/// forget.
bool survey(Work& work, double share) noexcept;

/// Whether images can be looked up in, and a tick has units for more than a few regions. O(1)
[[nodiscard]] bool can_survey(const Work& work) noexcept;

}  // namespace palpate::regions
