// SPDX-License-Identifier: GPL-3.0-or-later
// The side that a patch faces.
#pragma once

#include <array>
#include <span>

#include "host_bake/hull/hull.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {

struct PatchNormal {
  std::array<float, 3>
      mean{};              ///< of the triangles' unit normals, weighted by area; 0 without area
  float least_cosine = 0;  ///< between it and the normal of a triangle that has one; 0 without
};

/// @param points     [vertices] of the piece
/// @param triangles  their corners, counter-clockwise seen from outside
/// O(triangles).
PatchNormal patch_normal(std::span<const PointF> points,
                         std::span<const image::Triangle> triangles);

}  // namespace palpate::bake
