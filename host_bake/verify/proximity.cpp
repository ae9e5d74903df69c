// SPDX-License-Identifier: GPL-3.0-or-later
// The proximity grid against the triangles, as the engine reads it.
#include "rt_core/contact/nearby.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "host_bake/metrics/nearest.hpp"
#include "host_bake/verify/proofs.hpp"
#include "rt_core/image/triangle_normal.hpp"

namespace palpate::bake {
namespace {

// How much farther than the nearest triangle the named one may be. The engine lowers the bound that
// it takes from a cell by 2e-6 and more (contact::distance_bound), so that this is still a bound.
// Centres as the baker has them, in doubles, are off from the engine's, in floats, by three
// roundings of at most 6e-8 of the grid's length along each axis, which moves either distance by as
// much: 1.3e-6 between the two where the grid is 2 across, as for all but the smallest meshes.
constexpr double kFarther = 2e-6;

// NearestSurface is exact up to 2 from the origin. It allows for twice the rounding of points
// there, so that it misses nothing where coordinates are below 8 either; bakers make no larger
// grids.
constexpr double kFarthestCentre = 8;

NormalMesh mesh_of(const ImageView& image) {
  const auto triangles = image.region_triangles;
  NormalMesh mesh;
  mesh.points.reserve(3 * triangles.size());
  mesh.faces.reserve(triangles.size());
  for (const image::RegionTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (std::size_t c = 0; c < 9; c += 3) {
      mesh.points.push_back({t.corners[c], t.corners[c + 1], t.corners[c + 2]});
    }
    mesh.faces.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

std::string outside_grid(const ImageView& image) {
  const image::ProximityGrid& grid = *image.proximity_grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<double>(grid.origin[axis]);
    const double high =
        low + static_cast<double>(grid.cell) * image::kBrickEdge * grid.bricks[axis];
    for (std::size_t t = 0; t < image.region_triangles.size(); ++t) {
      for (std::size_t c = axis; c < 9; c += 3) {
        const auto at = static_cast<double>(image.region_triangles[t].corners[c]);
        if (at < low || at > high) return "triangle " + std::to_string(t) + " is outside the grid";
      }
    }
  }
  return {};
}

/// Centres as integers of half cells, so that every brick and every cell has one.
using HalfCells = std::array<std::uint32_t, 3>;

class Grid {
 public:
  explicit Grid(const ImageView& image) : image_(image), surface_(mesh_of(image)) {}

  [[nodiscard]] std::string wrong_brick(std::uint32_t brick) const {
    constexpr std::uint32_t kEdge = image::kBrickEdge;
    const auto& bricks = image_.proximity_grid->bricks;
    const HalfCells corner = {2 * kEdge * (brick % bricks[0]),
                              2 * kEdge * (brick / bricks[0] % bricks[1]),
                              2 * kEdge * (brick / bricks[0] / bricks[1])};
    std::uint32_t hint = 0;
    if ((image_.proximity_bricks[brick] & image::kCoarseBrick) != 0) {
      return wrong_at({corner[0] + kEdge, corner[1] + kEdge, corner[2] + kEdge}, hint);
    }
    for (std::uint32_t c = 0; c < image::kBrickCells; ++c) {
      const HalfCells at = {corner[0] + 2 * (c % kEdge) + 1,
                            corner[1] + 2 * (c / kEdge % kEdge) + 1,
                            corner[2] + 2 * (c / (kEdge * kEdge)) + 1};
      const std::string wrong = wrong_at(at, hint);
      if (!wrong.empty()) return "cell " + std::to_string(c) + ": " + wrong;
    }
    return {};
  }

 private:
  [[nodiscard]] float along(const HalfCells& at, std::size_t axis) const {
    const image::ProximityGrid& grid = *image_.proximity_grid;
    return grid.origin[axis] + grid.cell * (0.5f * static_cast<float>(at[axis]));
  }

  /// @param hint  of the search: from one cell to the next
  std::string wrong_at(const HalfCells& at, std::uint32_t& hint) const {
    const contact::ProximityCell cell =
        contact::cell_at(image_, {along(at, 0), along(at, 1), along(at, 2)});
    const Vec3d centre = vec_cast<double>(cell.centre);
    for (const double c : {centre.x, centre.y, centre.z}) {
      if (std::abs(c) > kFarthestCentre) return "its centre is far away";
    }
    const image::RegionTriangle& t = image_.region_triangles[cell.triangle];
    const Vec3d foot = nearest_on_triangle(centre, image::corner_of(t, 0), image::corner_of(t, 1),
                                           image::corner_of(t, 2));
    const Nearest nearest = surface_.nearest(centre, hint);
    hint = nearest.triangle;
    const double farther = norm(centre - foot) - std::sqrt(nearest.squared_distance);
    if (farther <= kFarther) return {};
    return "another triangle is nearer by " + std::to_string(farther);
  }

  const ImageView& image_;
  NearestSurface surface_;
};

}  // namespace

Proof prove_proximity(const Evidence& evidence) {
  const std::string invariant = "cells name the triangle nearest to them";
  const ImageView& image = evidence.image;
  if (image.proximity_grid == nullptr) return {invariant, true, "no regions"};
  const std::string outside = outside_grid(image);
  if (!outside.empty()) return {invariant, false, outside};
  const Grid grid(image);
  Proof proof = prove_each(invariant, Things{image.proximity_bricks.size(), "brick", "bricks"},
                           [&](std::uint32_t brick) { return grid.wrong_brick(brick); });
  if (proof.holds) {
    proof.found += ", " + std::to_string(image.proximity_cells.size()) + " cells of fine ones";
  }
  return proof;
}

}  // namespace palpate::bake
