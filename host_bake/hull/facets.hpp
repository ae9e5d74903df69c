// SPDX-License-Identifier: GPL-3.0-or-later
// Hulls in their canonical form: it depends on the point set alone, not on how the hull was found.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/hull/hull.hpp"
#include "host_bake/hull/predicates.hpp"

namespace palpate::bake {

using Triangle = std::array<std::uint32_t, 3>;

/// A hull, and which of its faces lie in one plane.
struct FacetHull {
  HullMesh mesh;
  std::vector<std::uint32_t> facet_of_face;  ///< 0, 1, ...; faces of one plane share a number
  std::uint32_t facets = 0;
};

/// From any triangulation of a solid hull's surface: `triangles` index `points`, are closed,
/// counter-clockwise seen from outside, and have area; vertices that are not extreme may occur.
/// Facets are triangulated as fans about their lowest vertex, each face starts with its lowest
/// vertex, faces are sorted. No two vertices used may have equal positions. O(n log n).
FacetHull canonical_hull(std::span<const PointF> points, std::span<const Triangle> triangles);

/// Extreme points of points in one plane, counter-clockwise seen from above, the lowest one first;
/// two for points on a line, one for a single point. `ids` index `points`; of equal points the
/// lowest id counts. Exact; O(n log n).
std::vector<std::uint32_t> flat_ring(std::span<const PointF> points, std::vector<std::uint32_t> ids,
                                     Projection view);

/// The hull whose extreme points flat_ring() gave, from any of them on: both sides, or none for
/// fewer than three points.
HullMesh canonical_flat_hull(std::span<const std::uint32_t> ring);

}  // namespace palpate::bake
