// SPDX-License-Identifier: Apache-2.0
// Some contact of two bodies about whose poses nothing is known.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Gives a region of a pair a witness nearer than delta, where one is found for what the tick has
/// left. Descends a's tree alone, always where it seems nearest (best first: Hjaltason and Samet
/// 1999): the centres of boxes, or of long ones places along them, are looked up in b's proximity
/// grid (look.hpp), and of a region sixteen triangles, whose pairs are measured. Of surfaces that
/// fit each other, one look at each of sixteen regions does; and whether most of those are behind
/// what is nearest to them makes it suspect that one body is inside the other (containment.hpp).
/// Regions that have been looked at in vain are not looked at again in the ticks to come, until
/// they may have come near: so the scouts of bodies that slide get farther from tick to tick. Where
/// there are units for it, the nearest of them are searched instead, until a pair near enough is
/// known or that there is none, which is kept. After a jump of a body so small that b's grid tells
/// nothing of it, both trees are. What is not quite near enough becomes a witness as well, for the
/// rest of the tick to climb from.
///
/// Looks prove nothing. They take a third of what a search of both trees takes that ends with the
/// first pair near enough (docs/TRIED.md, "Any contact first").
/// @param pair  whose images may have no grid: then nothing is done
/// @param most_units  to take for it, also where the tick has more
/// Cost: that and a batch, or all of a that seems to be nearer.
void scout(Work& work, std::uint32_t pair, double most_units) noexcept;

}  // namespace palpate::regions
