// SPDX-License-Identifier: GPL-3.0-or-later
// Directed Hausdorff distances h (Sec. 4.5), which widen the node tolerance of eq. 5.
#pragma once

#include <span>
#include <vector>

#include "host_bake/hierarchy/hierarchy.hpp"

namespace palpate::bake {

/// For every piece of the tree, how far a point of its descendants of level 0 lies outside the
/// piece's hull, for radius 1, rounded up; 0 where the hull encloses them (decided exactly), as
/// those of level 0 and of free levels do.
///
/// The distance to a convex set is a convex function, largest at extreme points of the descendants:
/// so h is exact up to rounding, where a sum over the levels would overestimate it. Parallel; the
/// same whatever the number of threads. O(sum of extreme points * faces of the hull).
std::vector<float> hausdorff_bounds(const Hierarchy& tree);

/// Largest distance of `points` to the hull with these faces, rounded up; exactly 0 where it
/// contains them.
float largest_distance(std::span<const PointF> points, std::span<const PointF> hull_points,
                       std::span<const std::array<std::uint32_t, 3>> faces, int dimension);

}  // namespace palpate::bake
