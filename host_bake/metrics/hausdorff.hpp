// SPDX-License-Identifier: GPL-3.0-or-later
// Directed Hausdorff distances h (Sec. 4.5), which widen the node tolerance of eq. 5.
#pragma once

#include <vector>

#include "host_bake/hierarchy/hierarchy.hpp"

namespace palpate::bake {

/// For every piece of the tree, an upper bound on how far a point of any descendant's hull lies
/// outside the piece's hull, for radius 1, rounded up; 0 where there are no descendants and where
/// the hull encloses them (decided exactly), as those of merge_to_root() do.
///
/// h(piece) = max over children of h(child) + distance of the child's hull vertices to the piece's
/// hull: the distance to a convex set is a convex function, largest at vertices, and the triangle
/// inequality does the rest. Parallel; the same whatever the number of threads. O(sum of child
/// vertices that the parent lacks * parent's faces).
std::vector<float> hausdorff_bounds(const Hierarchy& tree);

}  // namespace palpate::bake
