// SPDX-License-Identifier: Apache-2.0
// The point of a simplex of one to four points that is nearest to the origin.
#pragma once

#include <cstdint>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::convex {

/// The nearest point is sum of weight[i] * points[index[i]].
struct Nearest {
  Vec3d axis{};        ///< normal to the feature, from the origin towards it, any length; 0 where
                       ///< the origin lies on a vertex or edge
  double squared = 0;  ///< squared distance; 0 where the origin is enclosed
  std::uint32_t count =
      0;                   ///< points that carry the nearest one, 1 to 3; 4: the origin is enclosed
  std::uint32_t index[3];  ///< [count], ascending order not implied; not set where count is 4
  double weight[3];        ///< [count], > 0, sum 1; not set where count is 4
};

/// Twice the area vector of a triangle, (p1 - p0) x (p2 - p0), from its two shorter edges: the
/// least rounding of the three choices. `out_scale` is the product of those edges' squared lengths,
/// so that |result|^2 = sine^2 * out_scale.
[[nodiscard]] Vec3d area_normal(const Vec3d& p0, const Vec3d& p1, const Vec3d& p2,
                                double& out_scale) noexcept;

/// Of a segment; its points may coincide.
[[nodiscard]] Nearest nearest_on_segment(const Vec3d* points, std::uint32_t i,
                                         std::uint32_t j) noexcept;

/// Which features of a simplex may carry the nearest point.
enum class Carry : std::uint8_t {
  any,
  last,  ///< those with the last point. In GJK no other can once a support point is added; where
         ///< rounding says otherwise, insisting keeps the search from going in circles
};

/// Of a triangle; it may be degenerate.
///
/// The distance to a face is measured along its normal, taken from the two shorter edges, so that
/// the axis does not lose accuracy as the origin comes near. A triangle whose sine between those
/// edges is below kMinSine answers with its edges: they are then nearer to the truth than its
/// normal.
[[nodiscard]] Nearest nearest_on_triangle(const Vec3d* points, std::uint32_t i, std::uint32_t j,
                                          std::uint32_t k, Carry carry = Carry::any) noexcept;

/// Of 1 to 4 points in any position (after Montanari, Petrinic and Barbieri 2017: signs of volumes
/// decide which features can be nearest; here every feature that rounding leaves in doubt is tried
/// and the nearest taken). The origin counts as enclosed only where all signs are certain.
[[nodiscard]] Nearest nearest_on_simplex(const Vec3d* points, std::uint32_t count,
                                         Carry carry) noexcept;

/// Balance of two errors: a normal is off by 1e-16 / sine, an edge in its place by sine.
inline constexpr double kMinSine = 1e-8;

}  // namespace palpate::convex
