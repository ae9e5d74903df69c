// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface passes through itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// Boxes of faces that may meet before the search gives up: a scan has about ten a face, a heap of
/// copies has n^2.
inline constexpr std::size_t kMaxMeetings = 1'000'000;
inline constexpr std::size_t kMaxMeetingsPerFace = 100;

/// Pairs of faces (first < second, ascending) that have more in common than the vertices and edges
/// they share: they cross, touch or overlap, or fold back onto each other at their common edge.
/// Vertices at equal positions count as shared, so sheets that repair() has cut apart do not cross.
/// Faces without area take no part. Exact predicates (CGAL), all cores; the result does not depend
/// on their number. Nothing where more boxes meet than kMaxMeetings + kMaxMeetingsPerFace * faces.
/// O(n log n + boxes that meet). Precondition: finite points, indices in range.
std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> crossing_pairs(
    const Mesh& mesh);

/// The same for one pair: do they have more in common than the corners that are equal? Exact.
bool triangles_cross(const std::array<Point, 3>& a, const std::array<Point, 3>& b);

/// Are the three points on one line, exactly?
bool collinear(const Point& a, const Point& b, const Point& c);

}  // namespace palpate::bake
