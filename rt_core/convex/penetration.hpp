// SPDX-License-Identifier: Apache-2.0
// Penetration depth of two overlapping convex hulls.
#pragma once

#include <cstdint>

#include "rt_core/convex/distance.hpp"

namespace palpate::convex {

/// In the coordinates of a.
struct Penetration {
  double depth = 0;        ///< >= 0; moving a by depth * normal separates the hulls
  double lower_bound = 0;  ///< of the depth; equals depth up to rounding where exact
  Vec3d normal{};          ///< unit, from b to a
  Vec3d point_a{};         ///< deepest point of a inside b
  Vec3d point_b{};         ///< point_b - point_a = depth * normal
  bool exact = true;       ///< false: a cap was met; depth and normal still separate the hulls
};

inline constexpr std::uint32_t kMaxPenetrationVertices = 128;  ///< of the expanding polytope

/// Depth and direction of the least translation that separates a and b (expanding polytope, van den Bergen 2001, with
/// fixed arrays). Called after distance() answered penetrating or touching; starts from its cache.
///
/// Never fails: flat and identical hulls, concentric hulls and one hull inside another give a finite depth and a unit normal;
/// where the cap is met the answer is the best separating translation seen, exact = false. For two coplanar flat hulls
/// the depth is 0 and the normal theirs.
/// Cost: at most kMaxPenetrationVertices support pairs, O(vertices^2) face scans, about 30 KB of stack or the scratch of the
/// caller. No memory. Real-time safe.
struct PenetrationScratch;  // see penetration.cpp for what it holds
[[nodiscard]] Penetration penetration(const Hull& a, const Hull& b, const RelativePose& b_in_a, const Cache& cache,
                                      PenetrationScratch& scratch) noexcept;

}  // namespace palpate::convex
