// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/checks.hpp"

namespace palpate::image::checks {
namespace {

constexpr float kLeastCell = 1e-6f;

bool grid_sound(const ProximityGrid& grid) noexcept {
  for (const float c : grid.origin) {
    if (!within(c, -kMaxLength, kMaxLength)) return false;
  }
  return within(grid.cell, kLeastCell, kMaxLength);
}

bool bricks_counted(const ImageView& image) noexcept {
  std::uint64_t count = 1;
  for (const std::uint32_t n : image.proximity_grid->bricks) {
    if (n < 1 || n > kMaxBricksAcross) return false;
    count *= n;
  }
  return count == image.proximity_bricks.size() && image.proximity_grid->reserved == 0;
}

bool names_triangle(const ImageView& image, std::uint32_t index) noexcept {
  return index < image.region_triangles.size();
}

// Fine bricks' cells follow one another in the order of the bricks.
bool bricks_sound(const ImageView& image) noexcept {
  std::uint64_t fine = 0;
  for (const std::uint32_t brick : image.proximity_bricks) {
    const bool coarse = (brick & kCoarseBrick) != 0;
    if (coarse ? !names_triangle(image, brick & ~kCoarseBrick) : brick != fine) return false;
    fine += coarse ? 0u : 1u;
  }
  for (const std::uint32_t cell : image.proximity_cells) {
    if (!names_triangle(image, cell)) return false;
  }
  return fine * kBrickCells == image.proximity_cells.size();
}

}  // namespace

Status check_proximity(const ImageView& image) noexcept {
  if (image.proximity_grid == nullptr && image.proximity_bricks.empty() &&
      image.proximity_cells.empty()) {
    return Status::ok;
  }
  if (image.proximity_grid == nullptr || image.proximity_bricks.empty() ||
      image.proximity_cells.empty() || image.regions.empty()) {
    return Status::image_missing_section;
  }
  if (image.header->sections[static_cast<std::size_t>(SectionId::proximity_grid)].count != 1 ||
      !bricks_counted(image)) {
    return Status::image_bad_section;
  }
  if (!grid_sound(*image.proximity_grid)) return Status::image_bad_float;
  return bricks_sound(image) ? Status::ok : Status::image_bad_index;
}

}  // namespace palpate::image::checks
