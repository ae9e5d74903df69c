// SPDX-License-Identifier: Apache-2.0
// Contacts that come where few are felt, and searches have not got to them yet.
#pragma once

#include "rt_core/regions/work.hpp"

namespace palpate::regions {

/// Looks into regions that are not felt and of which nothing is proved any more, and then climbs
/// from the witnesses of all, felt or not, of which nothing is: in turn, some in each tick, with a
/// twentieth of what a tick has left and two fifths of the rest. Nothing where all is proved. For
/// ticks that go on from the one before under a budget: searches take a region at a time, tick
/// after tick where it is long, and what comes near meanwhile would be felt only when its turn has
/// come.
///
/// Proves nothing; witnesses are at the present poses as before, widths and urgencies of what has
/// changed are told anew. Where an image cannot be looked up in, or a tick has too few units
/// (can_survey()), nothing. Takes the queue of the query's memory as scratch.
/// Cost: those shares, and what one climb takes beyond; two passes over all active regions.
void watch(Work& work) noexcept;

}  // namespace palpate::regions
