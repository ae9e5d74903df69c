// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/look.hpp"

#include "rt_core/base/assert.hpp"

namespace palpate::regions {
namespace {

/// Of `cells` along an axis; what lies outside is in the outermost one.
std::uint32_t cell_at(float along, float per_length, std::uint32_t cells) noexcept {
  const float at = along * per_length;
  const auto last = static_cast<float>(cells - 1);
  return at > 0 ? static_cast<std::uint32_t>(at < last ? at : last) : 0;
}

/// Where the triangle near a point is kept.
const std::uint32_t* place_of(const ImageView& image, Vec3f p) noexcept {
  using image::kBrickEdge;
  const image::ProximityGrid& grid = *image.proximity_grid;
  const float per_length = 1 / grid.cell;
  const std::uint32_t x = cell_at(p.x - grid.origin[0], per_length, grid.bricks[0] * kBrickEdge);
  const std::uint32_t y = cell_at(p.y - grid.origin[1], per_length, grid.bricks[1] * kBrickEdge);
  const std::uint32_t z = cell_at(p.z - grid.origin[2], per_length, grid.bricks[2] * kBrickEdge);
  const std::uint32_t brick =
      (z / kBrickEdge * grid.bricks[1] + y / kBrickEdge) * grid.bricks[0] + x / kBrickEdge;
  const std::uint32_t* const kept = &image.proximity_bricks[brick];
  if ((*kept & image::kCoarseBrick) != 0) return kept;
  const std::uint32_t in_brick =
      (z % kBrickEdge * kBrickEdge + y % kBrickEdge) * kBrickEdge + x % kBrickEdge;
  return &image.proximity_cells[std::size_t{*kept} * image::kBrickCells + in_brick];
}

/// The run is passed through in steps of its golden section, so that any number of looks in a row
/// is spread over it: neighbours in it are neighbours on the surface.
std::uint32_t triangle_of(const image::RegionRun& run, std::uint32_t look) noexcept {
  constexpr std::uint32_t kGolden = 0x9e3779b1u;
  const std::uint64_t part = look * kGolden + kGolden / 2;
  return run.first + static_cast<std::uint32_t>((part & 0xffffffffu) * run.count >> 32);
}

}  // namespace

std::uint32_t near_place(const PairFrame& frame, Vec3f place) noexcept {
  PALPATE_ASSERT(can_look(frame));
  return *place_of(*frame.b, place) & ~image::kCoarseBrick;
}

/// Each pass asks for what the next one reads.
void look_from(const PairFrame& frame, std::uint32_t count, Witness (&pairs)[kMostLooks]) noexcept {
  for (std::uint32_t i = 0; i < count; ++i) {
    __builtin_prefetch(&frame.a->region_triangles[pairs[i].a]);
  }
  const std::uint32_t* places[kMostLooks];
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3f centre = centre_of(frame.a->region_triangles[pairs[i].a]);
    places[i] = place_of(*frame.b, at_place(frame.a_to_b, centre));
    __builtin_prefetch(places[i]);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    pairs[i].b = *places[i] & ~image::kCoarseBrick;
    __builtin_prefetch(&frame.b->region_triangles[pairs[i].b]);
  }
}

void look(const PairFrame& frame, std::uint32_t region, std::uint32_t from, std::uint32_t count,
          Witness (&out)[kMostLooks]) noexcept {
  PALPATE_ASSERT(count <= kMostLooks && can_look(frame));
  const image::RegionRun& run = frame.a->region_runs[region];
  for (std::uint32_t i = 0; i < count; ++i) out[i] = {triangle_of(run, from + i), 0, 0};
  look_from(frame, count, out);
}

std::uint32_t look_beside(const PairFrame& frame, std::uint32_t region, std::uint32_t triangle,
                          std::uint32_t count, Witness (&out)[kMostLooks]) noexcept {
  PALPATE_ASSERT(count <= kMostLooks && can_look(frame));
  const image::RegionRun& run = frame.a->region_runs[region];
  const std::uint32_t wanted = count < run.count ? count : run.count - 1;
  const std::uint32_t last = run.first + run.count - 1 - wanted;
  const std::uint32_t centred = triangle > wanted / 2 ? triangle - wanted / 2 : 0;
  std::uint32_t next = centred < run.first ? run.first : centred < last ? centred : last;
  std::uint32_t found = 0;
  for (; found < wanted; ++next) {
    if (next != triangle) out[found++] = {next, 0, 0};
  }
  look_from(frame, found, out);
  return found;
}

}  // namespace palpate::regions
