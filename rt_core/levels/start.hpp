// SPDX-License-Identifier: Apache-2.0
// Where a tick begins: last tick's front, or higher.
#pragma once

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// Puts all near front nodes on the queue.
///
/// A pair of bodies starts from its root at first and after a jump; where the roots' spheres or
/// hulls are delta or more apart, the root is its whole front. So the front is never deeper than a
/// cold start would make it there, and the pair costs one query. Where the budget would not do for
/// measuring the near nodes again, they give way to their parents, which take over the nearest
/// contact below them, those with the farthest first and no more than have to: what has been found
/// is felt, if coarser. Nodes are near by their motion bounds and, where these have run out, by
/// their spheres at the present pose. What the query of the roots proves holds for every pair of
/// pieces below them. O(front), and a query for each pair of bodies.
void start(Work& work) noexcept;

/// Puts a node on the queue if it is near.
void wait_if_near(Work& work, std::uint32_t index) noexcept;

/// Where a node that adds detail stands in the queue: less comes first.
///
/// Order::force (departure: the paper refines the largest s* first, which says what detail is
/// missing, not whether anything is felt there): the widest gap first, from `lower` up to the
/// contact that the node keeps, as far as its points are apart by now and the original surfaces may
/// be farther apart than those, or up to delta where it keeps none. Without a budget, and with
/// Order::deviation, the largest s*; free levels, which have none, first.
/// @param lower  what is proved of the distance
double rank(const Work& work, const Node& node, double lower) noexcept;

}  // namespace palpate::levels
