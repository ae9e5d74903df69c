// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/proximity_cells.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host_bake/base/parallel.hpp"

namespace palpate::bake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point3 = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr double kCellsPerDelta = 4.0 / 3;
constexpr double kCellsPerTriangle = 4;
constexpr double kFewestCells = 512;
constexpr double kCoarser = 1.15;       // from one try to the next
constexpr double kFinest = 1.0 / 1024;  // a cell
constexpr std::uint32_t kEdge = image::kBrickEdge;

Triangles triangles_of(std::span<const image::RegionTriangle> from) {
  Triangles out;
  out.reserve(from.size());
  for (const image::RegionTriangle& t : from) {
    const auto corner = [&](std::size_t i) {
      return Point3(double(t.corners[3 * i]), double(t.corners[3 * i + 1]),
                    double(t.corners[3 * i + 2]));
    };
    out.emplace_back(corner(0), corner(1), corner(2));
  }
  return out;
}

class Maker {
 public:
  Maker(const Triangles& triangles, double delta)
      : triangles_(triangles), tree_(triangles.begin(), triangles.end()), delta_(delta) {
    tree_.build();
    tree_.accelerate_distance_queries();
  }

  ProximityCells run() {
    const double most =
        std::max(kFewestCells, kCellsPerTriangle * static_cast<double>(triangles_.size()));
    cell_ = std::max(delta_ / kCellsPerDelta, kFinest);
    while (!lay_bricks(most)) cell_ *= kCoarser;
    fill_cells();
    return std::move(out_);
  }

 private:
  std::uint32_t nearest(const Point3& p) const {
    const auto at = tree_.closest_point_and_primitive(p).second;
    return static_cast<std::uint32_t>(at - triangles_.begin());
  }

  /// @return false where these cells are too many
  bool lay_bricks(double most) {
    const CGAL::Bbox_3 box = tree_.bbox();
    const double brick = cell_ * kEdge;
    double count = 1;
    for (int k = 0; k < 3; ++k) {
      // Half a brick and more beyond the surface, as much on both sides.
      const double across = std::floor((box.max(k) - box.min(k)) / brick) + 2;
      if (across > image::kMaxBricksAcross) return false;
      out_.grid.bricks[k] = static_cast<std::uint32_t>(across);
      out_.grid.origin[k] =
          static_cast<float>(0.5 * (box.max(k) + box.min(k)) - 0.5 * across * brick);
      count *= across;
    }
    if (count > most) return false;
    out_.grid.cell = static_cast<float>(cell_);
    out_.bricks.resize(static_cast<std::size_t>(count));
    std::vector<std::uint8_t> fine(out_.bricks.size());
    const double reach = 0.5 * std::numbers::sqrt3 * brick + delta_;
    parallel_for(out_.bricks.size(), [&](std::size_t i) {
      const Point3 centre = centre_of_brick(i);
      const std::uint32_t near = nearest(centre);
      fine[i] = CGAL::squared_distance(centre, triangles_[near]) < reach * reach ? 1 : 0;
      out_.bricks[i] = near | image::kCoarseBrick;
    });
    fine_.clear();
    for (std::size_t i = 0; i < fine.size(); ++i) {
      if (fine[i] == 0) continue;
      out_.bricks[i] = static_cast<std::uint32_t>(fine_.size());
      fine_.push_back(i);
    }
    return static_cast<double>(fine_.size()) * image::kBrickCells <= most;
  }

  void fill_cells() {
    out_.cells.resize(fine_.size() * image::kBrickCells);
    parallel_for(fine_.size(), [&](std::size_t i) {
      const std::array<double, 3> corner = corner_of_brick(fine_[i]);
      for (std::uint32_t c = 0; c < image::kBrickCells; ++c) {
        const Point3 centre(corner[0] + (c % kEdge + 0.5) * cell_,
                            corner[1] + (c / kEdge % kEdge + 0.5) * cell_,
                            corner[2] + (c / (kEdge * kEdge) + 0.5) * cell_);
        out_.cells[i * image::kBrickCells + c] = nearest(centre);
      }
    });
  }

  std::array<double, 3> corner_of_brick(std::size_t i) const {
    const std::size_t nx = out_.grid.bricks[0], ny = out_.grid.bricks[1];
    const std::array<std::size_t, 3> at = {i % nx, i / nx % ny, i / (nx * ny)};
    std::array<double, 3> out{};
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = double(out_.grid.origin[k]) + static_cast<double>(at[k]) * kEdge * cell_;
    }
    return out;
  }
  Point3 centre_of_brick(std::size_t i) const {
    const std::array<double, 3> corner = corner_of_brick(i);
    const double half = 0.5 * kEdge * cell_;
    return {corner[0] + half, corner[1] + half, corner[2] + half};
  }

  const Triangles& triangles_;
  Tree tree_;
  double delta_;
  double cell_ = 0;
  std::vector<std::size_t> fine_;  // bricks
  ProximityCells out_;
};

}  // namespace

ProximityCells proximity_cells(std::span<const image::RegionTriangle> triangles, double delta_rel) {
  return Maker(triangles_of(triangles), delta_rel).run();
}

}  // namespace palpate::bake
