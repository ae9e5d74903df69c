// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of unit normals: the cone about them, and their convex hull on the sphere.
#pragma once

#include <span>
#include <vector>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// A cone about the origin.
struct NormalCone {
  Vec3d axis{};        ///< unit; 0: none narrower than a half space was found
  double cosine = -1;  ///< of the half angle: the least cosine between the axis and a normal
};

/// The narrowest cone that holds the normals, nearly: its axis points to the point of their convex
/// hull that is nearest to the origin. Wider ones than a half space less some hundredths of a
/// degree count as none. No axis without normals. O(normals), at most a thousand passes
NormalCone normal_cone(std::span<const Vec3d> normals);

/// Without those that are the same to image::kEqualNormalCos as an earlier one. O(n^2)
std::vector<Vec3d> distinct_normals(std::span<const Vec3d> normals);

/// Corners of the convex hull on the sphere, counter-clockwise seen from outside; one normal or two
/// are their own. Corners that stand out by less than distinct normals are apart are left out.
/// Empty: the normals lie in no half space, as far as normal_cone() finds, and without normals.
/// @param normals  distinct
/// O(n log n)
std::vector<Vec3d> spherical_hull(std::span<const Vec3d> normals);

}  // namespace palpate::bake
