// SPDX-License-Identifier: GPL-3.0-or-later
// What the boxes of regions' trees are: small, about every point, and of parts that fit small ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "host_bake/metrics/vector.hpp"
#include "host_bake/regions/fitted_box.hpp"
#include "host_bake/regions/partition.hpp"

namespace palpate::test {
namespace {

using bake::FittedBox;
using bake::Partition;
using bake::unit;
using bake::vec;

Vec3d random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const double x = any(random);
  const double y = any(random);
  return {x, y, any(random)};
}

Mat3d random_axes(std::mt19937& random) {
  const Vec3d u = unit(random_point(random));
  const Vec3d v = unit(cross(u, random_point(random)));
  return {u, v, cross(u, v)};
}

double half_surface(const FittedBox& box) {
  const double a = double(box.half[0]), b = double(box.half[1]), c = double(box.half[2]);
  return 4 * (a * b + b * c + c * a);
}

TEST(FittedBox, holds_every_point_and_is_that_of_a_box_however_it_lies) {
  constexpr Vec3d kHalf{0.2, 0.1, 0.03};
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const Mat3d axes = transpose(random_axes(random));
    std::vector<Vec3d> points;
    for (int corner = 0; corner < 8; ++corner) {
      points.push_back(axes * Vec3d{corner & 1 ? kHalf.x : -kHalf.x,
                                    corner & 2 ? kHalf.y : -kHalf.y,
                                    corner & 4 ? kHalf.z : -kHalf.z});
    }
    // Some more on one side, so that the principal axes are not the box's.
    for (int k = 0; k < 12; ++k) {
      const Vec3d p = random_point(random);
      points.push_back(axes * Vec3d{kHalf.x * std::abs(p.x), kHalf.y * p.y, kHalf.z * p.z * p.x});
    }
    const FittedBox box = bake::fit_box(points, {}, {});
    for (const Vec3d& p : points) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double along = dot(vec(box.axes[k]), p - vec(box.centre));
        ASSERT_LE(std::abs(along), double(box.half[k]));
      }
    }
    const double least = 4 * (kHalf.x * kHalf.y + kHalf.y * kHalf.z + kHalf.z * kHalf.x);
    EXPECT_LE(half_surface(box), 1.01 * least) << i;
  }
}

/// A rhombus of 128 triangles; its corners lie `kLong` and `kShort` from the middle.
constexpr double kLong = 0.33;
constexpr double kShort = 0.3;
bake::NormalMesh rhombus() {
  constexpr std::uint32_t kSides = 8;
  bake::NormalMesh mesh;
  for (std::uint32_t i = 0; i <= kSides; ++i) {
    for (std::uint32_t k = 0; k <= kSides; ++k) {
      const double u = double(i) / kSides, v = double(k) / kSides;
      mesh.points.push_back({float(kLong * (u + v - 1)), float(kShort * (u - v)), 0});
    }
  }
  const auto at = [](std::uint32_t i, std::uint32_t k) { return i * (kSides + 1) + k; };
  for (std::uint32_t i = 0; i < kSides; ++i) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      mesh.faces.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.faces.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

/// The longest principal axis of a rhombus is a diagonal: across it there would be two triangles,
/// each as long as the other diagonal. Parts along the sides are shorter.
TEST(Partition, region_is_divided_into_round_parts) {
  const bake::NormalMesh mesh = rhombus();
  const Partition found = bake::divide(mesh, {.radius = 0.9});
  ASSERT_TRUE(found.nodes[0].region);
  double sum = 0;
  int groups = 0;
  for (const Partition::Node& node : found.nodes) {
    if (!Partition::is_group(node)) continue;
    ++groups;
    ASSERT_EQ(node.count, 16u);
    std::vector<Vec3d> corners;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      for (const std::uint32_t v : mesh.faces[found.faces[node.first + i]]) {
        corners.push_back(vec(mesh.points[v]));
      }
    }
    double farthest = 0;
    for (const Vec3d& p : corners) {
      for (const Vec3d& q : corners) farthest = std::max(farthest, norm(p - q));
    }
    sum += farthest;
  }
  ASSERT_EQ(groups, 8);
  const double side = std::hypot(kLong, kShort);
  const double of_half_by_quarter = side * std::hypot(0.5, 0.25);
  RecordProperty("longer", std::to_string(sum / groups / of_half_by_quarter));
  EXPECT_LT(sum / groups, 1.1 * of_half_by_quarter);
}

}  // namespace
}  // namespace palpate::test
