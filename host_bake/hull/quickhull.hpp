// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's quickhull, kept in one translation unit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/hull/facets.hpp"

namespace palpate::bake {

/// Some triangulation of the hull's surface, as canonical_hull() takes it. `ids` index `points`,
/// are ordered by position (lexicographically), hold no two equal positions and span the space.
/// There are more than four: CGAL 5.5.1 turns some single tetrahedra inside out. Exact; O(n log n)
/// expected.
std::vector<Triangle> quickhull(std::span<const PointF> points, std::span<const std::uint32_t> ids);

}  // namespace palpate::bake
