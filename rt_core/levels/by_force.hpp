// SPDX-License-Identifier: Apache-2.0
// Refinement under a budget in the order of what can still change the force (Order::force).
#pragma once

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// Where a node stands in the queue: less comes first.
///
/// Its gap is how far what is known of the nearest contact below it may be off: from what is proved
/// (Node::certain) up to the contact of original pieces that it keeps, as far as its points are
/// apart by now, or up to delta where it keeps none. Largest gap first. Where that is closed to
/// kOpenGap all that is left are other directions and places: after the open ones, by depth times
/// size, so that contacts are spread as evenly as the budget allows. Cost: O(1), no query.
double force_rank(const Work& work, const Node& node) noexcept;

/// Works the queue off while the budget lasts, where Work::by_force is set.
///
/// Departure from the paper, which refines the largest s* first: s* says what detail is missing,
/// but not whether anything is felt there, and the force is that of the deepest contact in each
/// direction (force/penalty.hpp). Simplified pieces (contact_dive) are measured first, nearest
/// first. Then, step by step, each a few queries, after which a node waits again with what it has
/// learnt: the bound of its culling hulls, a contact of original pieces (find, dive.hpp), a nearer
/// one (improve), and only then its children, one of which inherits the contact. Dives are for
/// nodes of kLeastDive to kLargestDive in size: above, a search would not come to its end; below,
/// it costs as much as measuring all pairs. A node that is not reached keeps its contact, measured
/// again at its points, so that contacts are not lost but age.
void refine_by_force(Work& work) noexcept;

}  // namespace palpate::levels
