// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons to triangles.
#pragma once

#include <span>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// Appends the triangles of one polygon (three corners or more, finite points) to `faces`, same
/// orientation, no new vertex. Four corners: the diagonal from the first, as most programs draw
/// them (what is felt is then what is seen, where the four are not in one plane), or the other
/// where that one lies outside; more: constrained Delaunay in the polygon's plane (CGAL), right for
/// non-convex ones too, and for those with holes reached along a bridge. A polygon that crosses
/// itself in that plane, or has no plane, becomes a fan round its first corner: check() then finds
/// what is wrong. O(n log n).
void triangulate(const std::vector<Point>& points, std::span<const std::uint32_t> polygon,
                 std::vector<Face>& faces);

}  // namespace palpate::bake
