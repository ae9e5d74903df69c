// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/look.hpp"

#include "rt_core/base/assert.hpp"

namespace palpate::regions {
namespace {

/// Square of the length that makes an edge long.
float longest2(float cell) noexcept {
  constexpr float kLongCells = 2;
  return kLongCells * kLongCells * cell * cell;
}

/// What lies outside of the grid is in the outermost cells, as in Kernels::find_bricks().
std::uint32_t cell_along(float place, const image::ProximityGrid& grid, int axis) noexcept {
  const auto last = static_cast<float>(grid.bricks[axis] * image::kBrickEdge - 1);
  const float at = (place - grid.origin[axis]) * (1 / grid.cell);
  return static_cast<std::uint32_t>(!(at > 0) ? 0 : at < last ? at : last);
}

/// Where the triangle near it is kept.
const std::uint32_t* place_of(const ImageView& image, const std::uint32_t* brick,
                              std::uint32_t in_brick) noexcept {
  if ((*brick & image::kCoarseBrick) != 0) return brick;
  return &image.proximity_cells[std::size_t{*brick} * image::kBrickCells + in_brick];
}

/// The run is passed through in steps of its golden section, so that any number of looks in a row
/// is spread over it: neighbours in it are neighbours on the surface.
std::uint32_t triangle_of(const image::RegionRun& run, std::uint32_t look) noexcept {
  constexpr std::uint32_t kGolden = 0x9e3779b1u;
  const std::uint64_t part = look * kGolden + kGolden / 2;
  return run.first + static_cast<std::uint32_t>((part & 0xffffffffu) * run.count >> 32);
}

void ask_for_triangles(const PairFrame& frame, Looks& looks) noexcept {
  for (std::uint32_t i = 0; i < looks.count; ++i) {
    __builtin_prefetch(&frame.a->region_triangles[looks.a[i]]);
  }
}

/// The lanes that are left repeat the first.
void find_bricks(const Kernels& kernels, const PairFrame& frame, Looks& looks) noexcept {
  const image::RegionTriangle* from[kBatch];
  for (std::uint32_t i = looks.count; i < kBatch; ++i) {
    looks.a[i] = looks.a[0];
    looks.number[i] = looks.number[0];
  }
  for (std::uint32_t i = 0; i < kBatch; ++i) from[i] = &frame.a->region_triangles[looks.a[i]];
  const image::ProximityGrid& grid = *frame.b->proximity_grid;
  BrickLanes found;
  kernels.find_bricks(from, looks.number, longest2(grid.cell * frame.b_to_a.scale), frame.a_to_b,
                      grid, found);
  static_assert(image::kBrickCells <= 256);
  for (std::uint32_t i = 0; i < looks.count; ++i) {
    looks.in_brick[i] = static_cast<std::uint8_t>(found.in_brick[i]);
    looks.at[i] = &frame.b->proximity_bricks[static_cast<std::uint32_t>(found.brick[i])];
    __builtin_prefetch(looks.at[i]);
  }
}

void find_places(const PairFrame& frame, Looks& looks) noexcept {
  for (std::uint32_t i = 0; i < looks.count; ++i) {
    looks.at[i] = place_of(*frame.b, looks.at[i], looks.in_brick[i]);
    __builtin_prefetch(looks.at[i]);
  }
}

void name_pairs(const PairFrame& frame, Looks& looks) noexcept {
  for (std::uint32_t i = 0; i < looks.count; ++i) {
    looks.b[i] = *looks.at[i] & ~image::kCoarseBrick;
    __builtin_prefetch(&frame.b->region_triangles[looks.b[i]]);
  }
}

}  // namespace

bool is_long(const image::RegionTriangle& t, float cell) noexcept {
  const float* c = t.corners;
  const Vec3f p = {c[0], c[1], c[2]}, q = {c[3], c[4], c[5]}, r = {c[6], c[7], c[8]};
  const float most2 = longest2(cell);
  return squared_norm(q - p) > most2 || squared_norm(r - q) > most2 || squared_norm(p - r) > most2;
}

/// Calls by name, not through a table, so that the stack report counts them.
void look_step(const Kernels& kernels, const PairFrame& frame, std::uint32_t step,
               Looks& looks) noexcept {
  PALPATE_ASSERT(step < kLookSteps && looks.count <= kMostLooks);
  if (looks.count == 0) return;
  switch (step) {
    case 0:
      return ask_for_triangles(frame, looks);
    case 1:
      return find_bricks(kernels, frame, looks);
    case 2:
      return find_places(frame, looks);
    default:
      return name_pairs(frame, looks);
  }
}

void look_from(const Kernels& kernels, const PairFrame& frame, Looks& looks) noexcept {
  PALPATE_ASSERT(can_look(frame));
  for (std::uint32_t step = 0; step < kLookSteps; ++step) look_step(kernels, frame, step, looks);
}

std::uint32_t near_place(const PairFrame& frame, Vec3f place) noexcept {
  PALPATE_ASSERT(can_look(frame));
  using image::kBrickEdge;
  const image::ProximityGrid& grid = *frame.b->proximity_grid;
  const std::uint32_t x = cell_along(place.x, grid, 0);
  const std::uint32_t y = cell_along(place.y, grid, 1);
  const std::uint32_t z = cell_along(place.z, grid, 2);
  const std::uint32_t brick =
      (z / kBrickEdge * grid.bricks[1] + y / kBrickEdge) * grid.bricks[0] + x / kBrickEdge;
  const std::uint32_t in_brick =
      (z % kBrickEdge * kBrickEdge + y % kBrickEdge) * kBrickEdge + x % kBrickEdge;
  const std::uint32_t* const at = &frame.b->proximity_bricks[brick];
  return *place_of(*frame.b, at, in_brick) & ~image::kCoarseBrick;
}

void look_over(const PairFrame& frame, std::uint32_t region, std::uint32_t from,
               std::uint32_t count, Looks& out) noexcept {
  PALPATE_ASSERT(out.count + count <= kMostLooks);
  const image::RegionRun& run = frame.a->region_runs[region];
  for (std::uint32_t i = 0; i < count; ++i) out.add(triangle_of(run, from + i), from + i);
}

void look_everywhere(const PairFrame& frame, Looks& out) noexcept {
  PALPATE_ASSERT(out.count == 0);
  const auto regions = static_cast<std::uint32_t>(frame.a->region_runs.size());
  const std::uint32_t count = regions < kMostLooks ? regions : kMostLooks;
  for (std::uint32_t i = 0; i < count; ++i) {
    const image::RegionRun& run = frame.a->region_runs[i * (regions / count)];
    out.add(run.first + run.count / 2, i);
  }
}

void look_beside(const PairFrame& frame, std::uint32_t region, std::uint32_t triangle,
                 std::uint32_t count, Looks& out) noexcept {
  PALPATE_ASSERT(out.count + count <= kMostLooks);
  const image::RegionRun& run = frame.a->region_runs[region];
  const std::uint32_t wanted = count < run.count ? count : run.count - 1;
  const std::uint32_t last = run.first + run.count - 1 - wanted;
  const std::uint32_t centred = triangle > wanted / 2 ? triangle - wanted / 2 : 0;
  std::uint32_t next = centred < run.first ? run.first : centred < last ? centred : last;
  for (std::uint32_t i = 0; i < wanted; ++next) {
    if (next != triangle) out.add(next, i++);
  }
}

}  // namespace palpate::regions
