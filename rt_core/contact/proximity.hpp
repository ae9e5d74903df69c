// SPDX-License-Identifier: Apache-2.0
// What the proximity grid of an image tells of a point, by one look.
#pragma once

#include <cstddef>

#include "rt_core/contact/nearby.hpp"

namespace palpate::contact {

/// A cell of the grid, or a brick of cells that are not told apart.
struct ProximityCell {
  Vec3f centre{};              ///< in the image's coordinates
  std::uint32_t triangle = 0;  ///< the nearest to the centre
};

/// The cell in which a point lies; of points outside the grid, the outermost one. Precondition: the
/// image has a proximity grid. O(1)
/// @param x  in the image's coordinates
inline ProximityCell cell_at(const ImageView& image, Vec3f x) noexcept {
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
  const auto centre = [&](std::uint32_t x_of, std::uint32_t y_of, std::uint32_t z_of, float half) {
    return Vec3f{grid.origin[0] + grid.cell * (static_cast<float>(x_of) + half),
                 grid.origin[1] + grid.cell * (static_cast<float>(y_of) + half),
                 grid.origin[2] + grid.cell * (static_cast<float>(z_of) + half)};
  };
  if ((named & image::kCoarseBrick) != 0) {
    constexpr float kHalf = 0.5f * kEdge;
    return {centre(cx - cx % kEdge, cy - cy % kEdge, cz - cz % kEdge, kHalf),
            named & ~image::kCoarseBrick};
  }
  const std::uint32_t cell = cx % kEdge + kEdge * (cy % kEdge + kEdge * (cz % kEdge));
  return {centre(cx, cy, cz, 0.5f),
          image.proximity_cells[std::size_t{named} * image::kBrickCells + cell]};
}

/// A lower bound of a point's signed distance, in the surface's coordinates: that of its cell's
/// centre, less how far it is from there; outside the grid, that of the grid. O(1)
double distance_bound(const Surface& surface, Vec3d x) noexcept;

}  // namespace palpate::contact
