// SPDX-License-Identifier: GPL-3.0-or-later
// Which points of a patch lie above which of its faces: exactly, and fast for most.
#pragma once

#include <cstdint>
#include <vector>

#include "host_bake/simplify/patch_shape.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// Double-precision planes and points of a shape. What lies below a plane by more than rounding can
/// explain is below; the rest is asked exactly.
class ShapePlanes {
 public:
  /// O(n).
  void set(const PatchShape& shape);
  /// A point of the shape has moved.
  void move(std::uint32_t point, const PointF& to);

  /// Point strictly above an unmoved face.
  [[nodiscard]] bool above(const PatchShape& shape, std::uint32_t face, std::uint32_t point) const;
  /// Any of the points first, ..., last - 1 strictly above a face, which may have moved.
  [[nodiscard]] bool any_above(const PatchShape& shape, std::uint32_t face, std::uint32_t first,
                               std::uint32_t last) const;

 private:
  struct Plane {
    Vec3d normal;    // not of unit length
    Vec3d origin;    // a corner
    double certain;  // a product beyond this has the right sign
  };
  [[nodiscard]] Plane plane_of(const PatchShape& shape, std::uint32_t face) const;
  [[nodiscard]] static bool above(const PatchShape& shape, const Plane& plane, std::uint32_t face,
                                  std::uint32_t point, Vec3d at);

  std::vector<Plane> planes_;
  std::vector<Vec3d> points_;
};

}  // namespace palpate::bake
