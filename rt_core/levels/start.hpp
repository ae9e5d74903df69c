// SPDX-License-Identifier: Apache-2.0
// Where a tick begins: last tick's front, or higher.
#pragma once

#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// Puts all near front nodes on the queue.
///
/// A pair of bodies starts from its root at first, after a jump, and without
/// Rules::front_tracking; where the roots' spheres, or with Rules::root_short_cut their hulls, are
/// delta or more apart, the root is its whole front. So the front is never deeper than a cold start
/// would make it there, and the pair costs one query. Where the budget would not do for measuring
/// the near nodes again, they give way to their parents, which take over the nearest contact below
/// them: what has been found is felt, if coarser. Nodes are near by their motion bounds
/// and, where these have run out, by their spheres at the present pose; without
/// Rules::motion_bounds by the spheres alone. O(front), and a query for each pair of bodies.
void start(Work& work) noexcept;

/// Puts a node on the queue if it is near.
void wait_if_near(Work& work, std::uint32_t index) noexcept;

/// Where a node that adds detail stands in the queue: less comes first.
double rank(const Work& work, const Node& node, double lower) noexcept;

}  // namespace palpate::levels
