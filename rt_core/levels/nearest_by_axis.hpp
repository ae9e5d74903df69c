// SPDX-License-Identifier: Apache-2.0
// How near the contacts of one pair of bodies are that push along about the same way.
#pragma once

#include <cstdint>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::levels {

/// For each of the six directions of the axes of a, the least distance of the contacts whose
/// normals are nearer to it than to any other. Every direction is felt as hard as its deepest
/// contact (force/penalty.hpp): what is farther along the same way adds nothing to the force.
/// Lengths in units. All O(1).
class NearestByAxis {
 public:
  void clear(double farthest) noexcept {
    for (double& d : least_) d = farthest;
  }
  /// @param normal  unit, in the coordinates of a
  void note(Vec3d normal, double distance) noexcept {
    double& least = least_[axis_of(normal)];
    if (distance < least) least = distance;
  }
  [[nodiscard]] bool is_nearer(Vec3d normal, double distance) const noexcept {
    return least_[axis_of(normal)] <= distance;
  }

 private:
  static std::uint32_t axis_of(Vec3d n) noexcept {
    const double x = n.x < 0 ? -n.x : n.x;
    const double y = n.y < 0 ? -n.y : n.y;
    const double z = n.z < 0 ? -n.z : n.z;
    if (x >= y && x >= z) return n.x < 0 ? 1 : 0;
    if (y >= z) return n.y < 0 ? 3 : 2;
    return n.z < 0 ? 5 : 4;
  }

  double least_[6] = {};
};

}  // namespace palpate::levels
