// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/look.hpp"

#include <bit>

#include "rt_core/base/assert.hpp"
#include "rt_core/regions/corner_lanes.hpp"
#include "rt_core/regions/simd.hpp"

namespace palpate::regions {
namespace {

/// Places side by side, and the cells of the grid that they lie in.
struct Cells {
  float at[3][kMostLooks] = {};
  std::int32_t cell[3][kMostLooks];
};
static_assert(kMostLooks == kBatch && kMostLooks % kLanes == 0);

void put(Vec3f place, std::uint32_t i, Cells& cells) noexcept {
  cells.at[0][i] = place.x;
  cells.at[1][i] = place.y;
  cells.at[2][i] = place.z;
}

/// Square of the length that makes an edge long.
float longest2(float cell) noexcept {
  constexpr float kLongCells = 2;
  return kLongCells * kLongCells * cell * cell;
}

/// @param Place  Vec3f, or several by lanes
template <class Place, class Length2>
auto has_long_edge(Place p, Place q, Place r, Length2 most2) noexcept {
  const auto length2 = [](Place e) { return e.x * e.x + e.y * e.y + e.z * e.z; };
  const auto longer = [](auto a, auto b) { return a > b ? a : b; };
  return longer(longer(length2(q - p), length2(r - q)), length2(p - r)) > most2;
}

/// Places whose numbers follow each other are spread over the triangle: multiples of the plastic
/// number's powers (Roberts 2018) in a parallelogram, of which one half is folded over the other.
Vec3f spread_over(const image::RegionTriangle& t, std::uint32_t number) noexcept {
  constexpr std::uint32_t kSteps[] = {0xc13fa9a9u, 0x91e10da5u};
  constexpr float kUnit = 0x1p-24f;
  float u = kUnit * static_cast<float>((number * kSteps[0] + 0x80000000u) >> 8);
  float v = kUnit * static_cast<float>((number * kSteps[1] + 0x80000000u) >> 8);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const float* c = t.corners;
  const auto at = [&](std::uint32_t axis) {
    return c[axis] + u * (c[3 + axis] - c[axis]) + v * (c[6 + axis] - c[axis]);
  };
  return {at(0), at(1), at(2)};
}

/// Triangles side by side.
using CornerLanes = float[9][kMostLooks];

/// Where a triangle is looked from, but for long ones.
/// @return bit i set where triangle i is long
std::uint32_t find_centres(const CornerLanes& corners, float cell, Cells& cells) noexcept {
  std::uint32_t long_ones = 0;
  for (std::uint32_t i = 0; i < kMostLooks; i += kLanes) {
    const auto corner = [&](std::uint32_t k) {
      return Vectors{load(&corners[k][i]), load(&corners[k + 1][i]), load(&corners[k + 2][i])};
    };
    const Vectors p = corner(0), q = corner(3), r = corner(6);
    const Vectors centre = all(kThird) * (p + q + r);
    store(centre.x, &cells.at[0][i]);
    store(centre.y, &cells.at[1][i]);
    store(centre.z, &cells.at[2][i]);
    long_ones |= bits(has_long_edge(p, q, r, all(longest2(cell)))) << i;
  }
  return long_ones;
}

/// From a's image coordinates to b's.
void bring_over(const Transform& a_to_b, Cells& cells) noexcept {
  for (std::uint32_t i = 0; i < kMostLooks; i += kLanes) {
    const Vectors in_a{load(&cells.at[0][i]), load(&cells.at[1][i]), load(&cells.at[2][i])};
    const Vectors in_b = at_place(a_to_b, in_a);
    store(in_b.x, &cells.at[0][i]);
    store(in_b.y, &cells.at[1][i]);
    store(in_b.z, &cells.at[2][i]);
  }
}

/// What lies outside of the grid is in the outermost cells.
void find_cells(const image::ProximityGrid& grid, Cells& cells) noexcept {
  const float per_length = 1 / grid.cell;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const Floats last = all(static_cast<float>(grid.bricks[axis] * image::kBrickEdge - 1));
    for (std::uint32_t i = 0; i < kMostLooks; i += kLanes) {
      const Floats at = (load(&cells.at[axis][i]) - grid.origin[axis]) * per_length;
      store(truncated(least(most(at, Floats{}), last)), &cells.cell[axis][i]);
    }
  }
}

/// In a box of so many places along x and y.
std::uint32_t number_of(const std::uint32_t (&at)[3], std::uint32_t x, std::uint32_t y) noexcept {
  return (at[2] * y + at[1]) * x + at[0];
}

/// Where the brick of a place is kept.
const std::uint32_t* brick_of(const ImageView& image, const Cells& cells, std::uint32_t i,
                              std::uint8_t& in_brick) noexcept {
  using image::kBrickEdge;
  const image::ProximityGrid& grid = *image.proximity_grid;
  std::uint32_t brick[3];
  std::uint32_t within[3];
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::uint32_t>(cells.cell[axis][i]);
    brick[axis] = cell / kBrickEdge;
    within[axis] = cell % kBrickEdge;
  }
  static_assert(image::kBrickCells <= 256);
  in_brick = static_cast<std::uint8_t>(number_of(within, kBrickEdge, kBrickEdge));
  return &image.proximity_bricks[number_of(brick, grid.bricks[0], grid.bricks[1])];
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

void find_bricks(const PairFrame& frame, Looks& looks) noexcept {
  Cells cells;
  CornerLanes corners;
  const auto triangle = [&](std::uint32_t i) -> const image::RegionTriangle& {
    return frame.a->region_triangles[looks.a[i]];
  };
  const image::RegionTriangle* from[kMostLooks];
  for (std::uint32_t i = 0; i < kMostLooks; ++i) from[i] = &triangle(i < looks.count ? i : 0);
  gather_corners(from, corners);
  const float cell = frame.b->proximity_grid->cell * frame.b_to_a.scale;
  std::uint32_t long_ones = find_centres(corners, cell, cells) & ((1u << looks.count) - 1);
  for (; long_ones != 0; long_ones &= long_ones - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(long_ones));
    put(spread_over(triangle(i), looks.number[i]), i, cells);
  }
  bring_over(frame.a_to_b, cells);
  find_cells(*frame.b->proximity_grid, cells);
  for (std::uint32_t i = 0; i < looks.count; ++i) {
    looks.at[i] = brick_of(*frame.b, cells, i, looks.in_brick[i]);
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
  return has_long_edge(Vec3f{c[0], c[1], c[2]}, Vec3f{c[3], c[4], c[5]}, Vec3f{c[6], c[7], c[8]},
                       longest2(cell));
}

/// Calls by name, not through a table, so that the stack report counts them.
void look_step(const PairFrame& frame, std::uint32_t step, Looks& looks) noexcept {
  PALPATE_ASSERT(step < kLookSteps && looks.count <= kMostLooks);
  if (looks.count == 0) return;
  switch (step) {
    case 0:
      return ask_for_triangles(frame, looks);
    case 1:
      return find_bricks(frame, looks);
    case 2:
      return find_places(frame, looks);
    default:
      return name_pairs(frame, looks);
  }
}

void look_from(const PairFrame& frame, Looks& looks) noexcept {
  PALPATE_ASSERT(can_look(frame));
  for (std::uint32_t step = 0; step < kLookSteps; ++step) look_step(frame, step, looks);
}

std::uint32_t near_place(const PairFrame& frame, Vec3f place) noexcept {
  PALPATE_ASSERT(can_look(frame));
  Cells cells;
  put(place, 0, cells);
  find_cells(*frame.b->proximity_grid, cells);
  std::uint8_t in_brick = 0;
  const std::uint32_t* const brick = brick_of(*frame.b, cells, 0, in_brick);
  return *place_of(*frame.b, brick, in_brick) & ~image::kCoarseBrick;
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
