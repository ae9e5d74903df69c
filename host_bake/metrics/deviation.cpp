// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "host_bake/base/parallel.hpp"
#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kMaxCorners = 8;

// Nearest points and cuts are off by a few roundings (2e-16) each; a cell's corners by those of all
// cuts before it.
constexpr double kAllRoundings = 1e-12;

// How far both halves reach from the cut, as a share of the cell's size: no endless slivers.
constexpr double kLeastCut = 0.05;

// A convex part of a level's triangle.
struct Cell {
  std::array<Vec3d, kMaxCorners> corners;
  std::uint32_t count = 0;     // of corners
  std::uint32_t nearest = 0;   // original triangle that bounds the distance
  std::uint32_t farthest = 0;  // the corner that is farthest from it
  bool centre_known = false;   // the triangle nearest to the centre has been tried
  double squared_bound = std::numeric_limits<double>::infinity();

  void add(Vec3d corner) { corners[count++] = corner; }
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
std::optional<Halves> cut(const Cell& cell, const Plane& plane, double least) {
  std::array<double, kMaxCorners> height{};
  double highest = 0, lowest = 0;
  for (std::size_t i = 0; i < cell.count; ++i) {
    height[i] = dot(plane.normal, cell.corners[i] - plane.origin);
    highest = std::max(highest, height[i]);
    lowest = std::min(lowest, height[i]);
  }
  if (!(highest > least && lowest < -least)) return std::nullopt;
  Halves halves;
  for (std::size_t i = 0, j = cell.count - 1; i < cell.count; j = i++) {
    if (std::max(halves.outer.count, halves.inner.count) + 2 > kMaxCorners) return std::nullopt;
    if ((height[j] < 0 && height[i] > 0) || (height[j] > 0 && height[i] < 0)) {
      const double share = height[j] / (height[j] - height[i]);
      const Vec3d crossing = cell.corners[j] + share * (cell.corners[i] - cell.corners[j]);
      halves.outer.add(crossing);
      halves.inner.add(crossing);
    }
    if (height[i] >= 0) halves.outer.add(cell.corners[i]);
    if (height[i] <= 0) halves.inner.add(cell.corners[i]);
  }
  return halves;
}

// Along the chord between two corners, which always can be done.
Halves cut_across(const Cell& cell) {
  Halves halves;
  const std::size_t middle = cell.count / 2;
  for (std::size_t i = 0; i <= middle; ++i) halves.outer.add(cell.corners[i]);
  for (std::size_t i = middle; i <= cell.count; ++i) halves.inner.add(cell.corners[i % cell.count]);
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

// Branch and bound over the triangles of one patch.
class PatchSearch {
 public:
  explicit PatchSearch(const NearestSurface& original) : original_(original) {}

  void add_triangle(const std::array<Vec3d, 3>& corners, const std::array<Nearest, 3>& nearest) {
    Cell cell;
    for (std::size_t i = 0; i < 3; ++i) {
      cell.add(corners[i]);
      squared_lower_ = std::max(squared_lower_, nearest[i].squared_distance);
    }
    for (const Nearest& n : nearest) bound_by(n.triangle, cell);
    cuts_left_ += kMaxCutsPerFace;
    put(cell);
  }

  // Of the distance, squared: bound from above.
  double run() {
    while (!queue_.empty()) {
      std::pop_heap(queue_.begin(), queue_.end(), less);
      Cell cell = queue_.back();
      queue_.pop_back();
      if (good(cell) || cuts_left_ == 0) return std::max(settled_, cell.squared_bound);
      const Side side = side_towards(original_.corners(cell.nearest), cell.farthest_corner());
      const double size = norm(cell.farthest_corner() - cell.centre());
      if (divide_at(side, size, cell)) continue;
      const std::uint32_t before = cell.nearest;
      const std::uint32_t other = try_nearest_to(cell.farthest_corner(), cell);
      if (cell.nearest != before) {
        put(cell);
      } else {
        divide(cell, size, other);
      }
    }
    return settled_;
  }

 private:
  static bool less(const Cell& a, const Cell& b) { return a.squared_bound < b.squared_bound; }

  [[nodiscard]] bool good(const Cell& cell) const {
    constexpr double kFactor = (1 + kDeviationExcess) * (1 + kDeviationExcess);
    return cell.squared_bound <=
           std::max(kFactor * squared_lower_, kDeviationTolerance * kDeviationTolerance);
  }

  // The lower bound only grows: what is good now need not be queued.
  void put(const Cell& cell) {
    if (good(cell)) {
      settled_ = std::max(settled_, cell.squared_bound);
      return;
    }
    queue_.push_back(cell);
    std::push_heap(queue_.begin(), queue_.end(), less);
  }

  void bound_by(std::uint32_t triangle, Cell& cell) const {
    double largest = 0;
    std::uint32_t farthest = 0;
    for (std::uint32_t i = 0; i < cell.count && largest < cell.squared_bound; ++i) {
      const double squared = original_.squared_distance(cell.corners[i], triangle);
      if (squared <= largest) continue;
      largest = squared;
      farthest = i;
    }
    if (largest >= cell.squared_bound) return;
    cell.squared_bound = largest;
    cell.nearest = triangle;
    cell.farthest = farthest;
  }

  std::uint32_t try_nearest_to(Vec3d p, Cell& cell) {
    const Nearest found = original_.nearest(p, cell.nearest);
    squared_lower_ = std::max(squared_lower_, found.squared_distance);
    bound_by(found.triangle, cell);
    return found.triangle;
  }

  // Where a corner is beyond a side of the triangle, the neighbour there is nearer to it.
  bool divide_at(const Side& side, double size, Cell& cell) {
    if (side.outside < kLeastCut * size) return false;
    if (!cell.centre_known && side.outside > size / 2) {
      cell.centre_known = true;
      try_nearest_to(cell.centre(), cell);
      put(cell);
      return true;
    }
    const std::optional<Halves> halves = cut(cell, side.plane, kLeastCut * size);
    if (!halves) return false;
    const std::uint32_t other = original_.neighbour(cell.nearest, side.number);
    put(*halves, cell.nearest, other == kNoTriangle ? cell.nearest : other);
    return true;
  }

  void divide(const Cell& cell, double size, std::uint32_t other) {
    const Vec3d centre = cell.centre();
    const Plane across{unit(cell.farthest_corner() - centre), centre};
    const std::optional<Halves> halves = cut(cell, across, kLeastCut * size);
    put(halves ? *halves : cut_across(cell), cell.nearest, other);
  }

  void put(Halves halves, std::uint32_t one, std::uint32_t other) {
    --cuts_left_;
    for (Cell* half : {&halves.inner, &halves.outer}) {
      bound_by(one, *half);
      bound_by(other, *half);
      put(*half);
    }
  }

  const NearestSurface& original_;
  std::vector<Cell> queue_;   // a heap, the largest bound first
  double squared_lower_ = 0;  // some point of the patch is as far as this
  double settled_ = 0;        // largest squared bound of cells that are good
  std::size_t cuts_left_ = 0;
};

float rounded_up(double squared) {
  const double wanted = std::sqrt(squared) * (1 + kAllRoundings) + kAllRoundings;
  const auto f = static_cast<float>(wanted);
  return static_cast<double>(f) < wanted ? std::nextafter(f, std::numeric_limits<float>::infinity())
                                         : f;
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
    deviations[i] = rounded_up(search.run());
  });
  return deviations;
}

}  // namespace palpate::bake
