// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "host_bake/base/parallel.hpp"
#include "host_bake/base/round_up.hpp"
#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kMaxCorners = 7;

// Nearest points and cuts are off by a few roundings (2e-16) each; a cell's corners by those of all
// cuts before it.
constexpr double kAllRoundings = 1e-12;

// How far both halves reach from the cut, as a share of the cell's size: no endless slivers.
constexpr double kLeastCut = 0.05;

// A convex part of a level's triangle, and the original triangle that bounds its distance.
struct Cell {
  std::array<Vec3d, kMaxCorners> corners;
  std::array<double, kMaxCorners> squared;  // distances of the corners to `nearest`
  std::uint32_t count = 0;                  // of corners
  std::uint32_t nearest = 0;
  std::uint32_t farthest = 0;  // corner with the largest distance
  bool centre_known = false;   // the triangle nearest to the centre has been tried

  void add(Vec3d corner, double squared_distance) {
    corners[count] = corner;
    squared[count] = squared_distance;
    if (squared_distance > squared[farthest]) farthest = count;
    ++count;
  }
  [[nodiscard]] double squared_bound() const { return squared[farthest]; }
  [[nodiscard]] Vec3d farthest_corner() const { return corners[farthest]; }
  [[nodiscard]] Vec3d centre() const {
    Vec3d sum;
    for (std::size_t i = 0; i < count; ++i) sum += corners[i];
    return (1.0 / count) * sum;
  }
};

struct Plane {
  Vec3d normal, origin;  // of unit length; any of the plane
};

struct Halves {
  Cell outer, inner;
};

// Nothing where a half would reach less than `least` from the plane, or have too many corners.
std::optional<Halves> cut(const Cell& cell, const Plane& plane, double least,
                          const NearestSurface& original) {
  std::array<double, kMaxCorners> height{};
  double highest = 0, lowest = 0;
  for (std::size_t i = 0; i < cell.count; ++i) {
    height[i] = dot(plane.normal, cell.corners[i] - plane.origin);
    highest = std::max(highest, height[i]);
    lowest = std::min(lowest, height[i]);
  }
  if (!(highest > least && lowest < -least)) return std::nullopt;
  std::optional<Halves> result(std::in_place);
  Cell &outer = result->outer, &inner = result->inner;
  outer.nearest = inner.nearest = cell.nearest;
  for (std::size_t i = 0, j = cell.count - 1; i < cell.count; j = i++) {
    if (std::max(outer.count, inner.count) + 2 > kMaxCorners) return std::nullopt;
    if ((height[j] < 0 && height[i] > 0) || (height[j] > 0 && height[i] < 0)) {
      const double share = height[j] / (height[j] - height[i]);
      const Vec3d crossing = cell.corners[j] + share * (cell.corners[i] - cell.corners[j]);
      const double squared = original.squared_distance(crossing, cell.nearest);
      outer.add(crossing, squared);
      inner.add(crossing, squared);
    }
    if (height[i] >= 0) outer.add(cell.corners[i], cell.squared[i]);
    if (height[i] <= 0) inner.add(cell.corners[i], cell.squared[i]);
  }
  return result;
}

// Along the chord between two corners, which always can be done.
Halves cut_across(const Cell& cell) {
  Halves halves;
  halves.outer.nearest = halves.inner.nearest = cell.nearest;
  const std::size_t middle = cell.count / 2;
  for (std::size_t i = 0; i <= middle; ++i) halves.outer.add(cell.corners[i], cell.squared[i]);
  for (std::size_t i = middle; i <= cell.count; ++i) {
    const std::size_t corner = i % cell.count;
    halves.inner.add(cell.corners[corner], cell.squared[corner]);
  }
  return halves;
}

// A side of a triangle.
struct Side {
  std::size_t number = 0;  // as of NearestSurface::neighbour()
  Plane plane;             // upright on the triangle, outward
  double outside = 0;      // how far a point is outside of it
};

// The side that p is farthest outside of.
Side side_towards(const std::array<Vec3d, 3>& triangle, Vec3d p) {
  const Vec3d up = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  Side farthest;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d outward = unit(cross(triangle[(i + 1) % 3] - triangle[i], up));
    const double outside = dot(outward, p - triangle[i]);
    if (outside > farthest.outside) farthest = {i, {outward, triangle[i]}, outside};
  }
  return farthest;
}

// Branch and bound over the triangles of one patch, one after the other.
class PatchSearch {
 public:
  explicit PatchSearch(const NearestSurface& original) : original_(original) {}

  void add_triangle(const std::array<Vec3d, 3>& corners, const std::array<Nearest, 3>& nearest) {
    Cell cell;
    cell.nearest = nearest[0].triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      cell.add(corners[i], original_.squared_distance(corners[i], cell.nearest));
      squared_lower_ = std::max(squared_lower_, nearest[i].squared_distance);
    }
    bound_by(nearest[1].triangle, cell);
    bound_by(nearest[2].triangle, cell);
    triangles_.push_back(cell);
  }

  // Of the distance, squared: bound from above.
  double run() {
    // What is far comes first: its lower bounds settle most of the others at once.
    std::sort(triangles_.begin(), triangles_.end(),
              [](const Cell& a, const Cell& b) { return a.squared_bound() > b.squared_bound(); });
    for (const Cell& triangle : triangles_) settle(triangle);
    return settled_;
  }

 private:
  [[nodiscard]] bool good(const Cell& cell) const {
    constexpr double kFactor = (1 + kDeviationExcess) * (1 + kDeviationExcess);
    return cell.squared_bound() <=
           std::max(kFactor * squared_lower_, kDeviationTolerance * kDeviationTolerance);
  }

  void settle(const Cell& triangle) {
    put(triangle);
    for (std::size_t cuts = 0; !open_.empty();) {
      Cell cell = open_.back();
      open_.pop_back();
      if (good(cell) || cuts == kMaxCuts) {
        settled_ = std::max(settled_, cell.squared_bound());
      } else if (refine(cell)) {
        ++cuts;
      }
    }
  }

  // The lower bound only grows: what is good now stays so.
  void put(const Cell& cell) {
    if (good(cell)) {
      settled_ = std::max(settled_, cell.squared_bound());
    } else {
      open_.push_back(cell);
    }
  }

  // Whether that makes the bound smaller.
  bool bound_by(std::uint32_t triangle, Cell& cell) const {
    if (triangle == cell.nearest) return false;
    std::array<double, kMaxCorners> squared{};
    std::uint32_t farthest = 0;
    for (std::uint32_t i = 0; i < cell.count; ++i) {
      squared[i] = original_.squared_distance(cell.corners[i], triangle);
      if (squared[i] >= cell.squared_bound()) return false;
      if (squared[i] > squared[farthest]) farthest = i;
    }
    cell.squared = squared;
    cell.nearest = triangle;
    cell.farthest = farthest;
    return true;
  }

  std::uint32_t nearest_to(Vec3d p, const Cell& cell) {
    const Nearest found = original_.nearest(p, cell.nearest);
    squared_lower_ = std::max(squared_lower_, found.squared_distance);
    return found.triangle;
  }

  // Finds a better triangle for the cell or cuts it; true where it does that.
  bool refine(Cell& cell) {
    const double size = norm(cell.farthest_corner() - cell.centre());
    const Side side = side_towards(original_.corners(cell.nearest), cell.farthest_corner());
    if (side.outside > 0.3 * size && !cell.centre_known) {
      cell.centre_known = true;
      bound_by(nearest_to(cell.centre(), cell), cell);
      put(cell);
      return false;
    }
    if (side.outside > kLeastCut * size && cut_at(side, size, cell)) return true;
    const std::uint32_t other = nearest_to(cell.farthest_corner(), cell);
    if (good(cell) || bound_by(other, cell)) {
      put(cell);
      return false;
    }
    cut_in_two(cell, size, other);
    return true;
  }

  // Beyond a side of the triangle, its neighbour there is nearer.
  bool cut_at(const Side& side, double size, const Cell& cell) {
    std::optional<Halves> halves = cut(cell, side.plane, kLeastCut * size, original_);
    if (!halves) return false;
    const std::uint32_t neighbour = original_.neighbour(cell.nearest, side.number);
    if (neighbour != kNoTriangle) bound_by(neighbour, halves->outer);
    put(*halves);
    return true;
  }

  void cut_in_two(const Cell& cell, double size, std::uint32_t other) {
    const Vec3d centre = cell.centre();
    const Plane across{unit(cell.farthest_corner() - centre), centre};
    std::optional<Halves> halves = cut(cell, across, kLeastCut * size, original_);
    if (!halves) halves = cut_across(cell);
    bound_by(other, halves->inner);
    bound_by(other, halves->outer);
    put(*halves);
  }

  // The larger bound is looked at first.
  void put(const Halves& halves) {
    const bool outer_first = halves.outer.squared_bound() > halves.inner.squared_bound();
    put(outer_first ? halves.inner : halves.outer);
    put(outer_first ? halves.outer : halves.inner);
  }

  const NearestSurface& original_;
  std::vector<Cell> triangles_;
  std::vector<Cell> open_;    // a stack, parts of one triangle
  double squared_lower_ = 0;  // some point of the patch is as far as this
  double settled_ = 0;        // largest squared bound of cells that are good
};

float bound_of_root(double squared) {
  return rounded_up(std::sqrt(squared) * (1 + kAllRoundings) + kAllRoundings);
}

}  // namespace

std::vector<float> surface_deviations(const NearestSurface& original, const NormalMesh& level,
                                      const std::vector<Patch>& patches) {
  // Of all vertices beforehand, since each is a corner of several triangles.
  std::vector<Nearest> nearest(level.points.size());
  parallel_for(nearest.size(),
               [&](std::size_t v) { nearest[v] = original.nearest(vec(level.points[v])); });
  std::vector<float> deviations(patches.size());
  parallel_for(patches.size(), [&](std::size_t i) {
    PatchSearch search(original);
    for (const std::uint32_t f : patches[i].faces) {
      const Face& face = level.faces[f];
      search.add_triangle(
          {vec(level.points[face[0]]), vec(level.points[face[1]]), vec(level.points[face[2]])},
          {nearest[face[0]], nearest[face[1]], nearest[face[2]]});
    }
    deviations[i] = bound_of_root(search.run());
  });
  return deviations;
}

}  // namespace palpate::bake
