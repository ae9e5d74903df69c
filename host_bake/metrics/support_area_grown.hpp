// SPDX-License-Identifier: GPL-3.0-or-later
// Support areas of faces grown from each vertex; see support_area.hpp for what they are.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// Share of a triangle's area that lies at heights up to `limit`, from the heights of its corners
/// in ascending order.
inline double share_below(const std::array<double, 3>& heights, double limit) {
  const auto [low, middle, high] = heights;
  if (limit >= high) return 1;
  if (limit <= low) return 0;
  // With one corner above the limit, what is cut off is a triangle at that corner; with two, what
  // stays is one at the lowest.
  if (limit >= middle)
    return 1 - (high - limit) / (high - low) * ((high - limit) / (high - middle));
  return (limit - low) / (middle - low) * ((limit - low) / (high - low));
}

/// Share of a triangle's area at heights of at most `limit` up or down.
inline double share_within(std::array<double, 3> heights, double limit) {
  std::sort(heights.begin(), heights.end());
  return share_below(heights, limit) - share_below(heights, -limit);
}

/// D of every vertex under SupportReading::grown, without the floor.
std::vector<double> grown_areas(const NormalMesh& mesh, const std::vector<Vec3d>& normals,
                                double delta_rel);

}  // namespace palpate::bake
