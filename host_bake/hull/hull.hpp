// SPDX-License-Identifier: GPL-3.0-or-later
// Convex hulls of float points, by exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::bake {

using PointF = std::array<float, 3>;

/// The hull of a point set. Flat, straight and single-point sets have hulls too.
struct HullMesh {
  std::vector<std::uint32_t>
      vertices;  ///< indices into the points given: extreme points only, ascending
  std::vector<std::array<std::uint32_t, 3>>
      faces;          ///< indices into `vertices`, counter-clockwise seen from outside;
                      ///< a flat hull has both sides; empty for straight and single-point hulls
  int dimension = 3;  ///< 0 point, 1 segment, 2 flat, 3 solid (decided exactly)
};

/// Points may repeat. Deterministic. O(n log n) expected.
HullMesh convex_hull(std::span<const PointF> points);

}  // namespace palpate::bake
