// SPDX-License-Identifier: Apache-2.0
// Hulls and poses for the tests of the convex queries, and proofs of their answers that share no
// code with them.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "rt_core/convex/distance.hpp"
#include "rt_core/convex/hull.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::convex::test {

using Random = std::mt19937_64;

inline constexpr Enough kExact{};

/// A hull that owns its memory.
struct Shape {
  std::vector<image::Vertex> vertices;
  std::vector<std::uint32_t> starts;  ///< empty: no adjacency
  std::vector<std::uint32_t> neighbours;

  [[nodiscard]] Hull hull(double scale = 1) const;
};

double uniform(Random& random, double low, double high);
Vec3d random_unit(Random& random);
Quat random_rotation(Random& random);
Quat about(Vec3d axis, double angle_rad);

/// The points as they are, without adjacency: for up to image::kAdjacencyAbove extreme points, or
/// any points where the scan is wanted.
Shape cloud(const std::vector<Vec3d>& points);
/// The extreme points of the points, rounded to 2^-20, with adjacency where there are more than
/// image::kAdjacencyAbove. Coplanar points allowed, not all of them.
Shape convex_hull(const std::vector<Vec3d>& points);

Shape point(Vec3d p);
Shape segment(Vec3d p, Vec3d q);
Shape triangle(Vec3d p, Vec3d q, Vec3d r);
Shape box(Vec3d half);
Shape prism(std::uint32_t sides, double radius, double half_height);
/// `count` points on an ellipsoid; fewer than four where count says so.
Shape ellipsoid(std::uint32_t count, Vec3d half, Random& random);
/// `count` points on a shallow spherical cap off the origin, as patches of a fine mesh are.
Shape cap(std::uint32_t count, double radius, Random& random);
/// One of all of the above; at most `max_vertices` vertices.
Shape any_shape(std::uint32_t max_vertices, Random& random);

/// Points of a hull in the coordinates of a, as real as long double makes them.
using Real = Vec3<long double>;
Real real_a(const Hull& a, std::uint32_t i);
Real real_b(const Hull& b, const RelativePose& b_in_a, std::uint32_t i);
/// Width of the gap between a and b along a direction (normalised here); negative: overlap.
long double gap_along(const Hull& a, const Hull& b, const RelativePose& b_in_a, Vec3d normal);

/// Proves an answer of distance(): the witnesses are convex combinations as far apart as stated,
/// and the slab along the normal is as wide as stated, so that the truth lies between; where
/// penetrating, the cached simplex holds the origin. Empty where proved, else what is wrong.
const char* refute(const Hull& a, const Hull& b, const RelativePose& b_in_a, const Distance& d,
                   const Cache& cache);

}  // namespace palpate::convex::test
