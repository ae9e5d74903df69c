// SPDX-License-Identifier: GPL-3.0-or-later
// The proximity grid of an image: for each cell about the surface a triangle near its centre.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/image/region_format.hpp"

namespace palpate::bake {

struct ProximityCells {
  image::ProximityGrid grid{};
  std::vector<std::uint32_t> bricks;
  std::vector<std::uint32_t> cells;
};

/// Cells of three quarters of a contact tolerance, or larger ones where there would be more than
/// four for each triangle (sixteen bytes, beside the 250 that a triangle takes without). Bricks
/// nearer to the surface than a tolerance are fine.
///
/// Each names the triangle nearest to its centre (CGAL's AABB tree). Deterministic, also across
/// numbers of threads. O((cells + triangles) log triangles)
/// @param triangles  in the order of the image, radius 1; at least one
/// @param delta_rel  contact tolerance that the image is made for; 0: none is known
ProximityCells proximity_cells(std::span<const image::RegionTriangle> triangles, double delta_rel);

}  // namespace palpate::bake
