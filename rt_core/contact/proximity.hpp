// SPDX-License-Identifier: Apache-2.0
// A triangle near a point, by one look into the proximity grid of an image.
#pragma once

#include <cstddef>

#include "rt_core/contact/surface.hpp"

namespace palpate::contact {

/// The triangle that is nearest to the centre of the grid's cell in which a point lies; of points
/// outside the grid, of the outermost cell. Precondition: the image has a proximity grid. O(1)
/// @param x  in the image's coordinates
inline std::uint32_t triangle_near(const ImageView& image, Vec3f x) noexcept {
  const image::ProximityGrid& grid = *image.proximity_grid;
  const float per_cell = 1 / grid.cell;
  const auto cell_along = [&](float place, std::size_t axis) {
    const auto last = static_cast<float>(grid.bricks[axis] * image::kBrickEdge - 1);
    const float at = per_cell * (place - grid.origin[axis]);
    return static_cast<std::uint32_t>(!(at > 0) ? 0 : at < last ? at : last);
  };
  const std::uint32_t cx = cell_along(x.x, 0);
  const std::uint32_t cy = cell_along(x.y, 1);
  const std::uint32_t cz = cell_along(x.z, 2);
  constexpr std::uint32_t kEdge = image::kBrickEdge;
  const std::size_t row = cy / kEdge + std::size_t{grid.bricks[1]} * (cz / kEdge);
  const std::uint32_t named = image.proximity_bricks[cx / kEdge + grid.bricks[0] * row];
  if ((named & image::kCoarseBrick) != 0) return named & ~image::kCoarseBrick;
  const std::uint32_t cell = cx % kEdge + kEdge * (cy % kEdge + kEdge * (cz % kEdge));
  return image.proximity_cells[std::size_t{named} * image::kBrickCells + cell];
}

/// @param x  in the surface's coordinates
inline std::uint32_t triangle_near(const Surface& surface, Vec3d x) noexcept {
  return triangle_near(*surface.image, vec_cast<float>((1 / surface.scale) * x));
}

}  // namespace palpate::contact
