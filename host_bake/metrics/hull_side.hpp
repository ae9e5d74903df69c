// SPDX-License-Identifier: GPL-3.0-or-later
// Where points lie with respect to a hull: exact containment, and the distance of those outside.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/hull/hull.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// A hull, prepared for many points. Borrows its arguments.
class HullSide {
 public:
  /// @param points     its extreme points, within image::kMaxNorm of the origin
  /// @param faces      indices into points, counter-clockwise seen from outside; both sides of a
  /// flat hull
  /// @param dimension  of the hull, as in HullMesh
  HullSide(std::span<const PointF> points, std::span<const std::array<std::uint32_t, 3>> faces,
           int dimension);

  /// In the hull or on it; exact. O(faces) for a solid hull, O(points log points) for lesser ones.
  [[nodiscard]] bool contains(const PointF& p) const;

  /// 0 where contains(p), else the distance to the hull in double. O(faces).
  [[nodiscard]] double distance(const PointF& p) const;

 private:
  struct Plane {
    Vec3d normal;  // not of unit length
    Vec3d origin;
    double certain;  // a value below minus this is inside, whatever was rounded
  };
  [[nodiscard]] bool below_all_planes(const PointF& p) const;

  std::span<const PointF> points_;
  std::span<const std::array<std::uint32_t, 3>> faces_;
  int dimension_;
  std::vector<Plane> planes_;
};

}  // namespace palpate::bake
