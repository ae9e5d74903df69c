// SPDX-License-Identifier: GPL-3.0-or-later
// The facets of a patch's hull that are no faces of the patch.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/hull/growing_hull.hpp"
#include "host_bake/simplify/patch_shape.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// All around an inner vertex of a patch the hull has the patch's own faces. So a collapse inside
/// the patch leaves these facets as they are, unless the new vertex rises above one; the hull grows
/// by no more than the hull of the new vertex and its ring then. Facets divided otherwise than the
/// patch's faces in their plane count as virtual.
class VirtualFacets {
 public:
  /// O(n log n).
  void set(const PatchShape& shape, const GrowingHull& hull);

  /// The vertex (of the surface) is a corner of one.
  [[nodiscard]] bool has_corner(std::uint32_t vertex) const;
  /// The point lies below all of them, clearly.
  [[nodiscard]] bool clearly_below(const PointF& p) const;
  /// The triangle lies beyond one of them, moved inward by kShrink_rel.
  [[nodiscard]] bool separate(const std::array<PointF, 3>& triangle) const;

 private:
  struct Plane {
    Vec3d normal;  // unit, outward
    double offset;
  };
  std::vector<Plane> planes_;
  std::vector<std::uint32_t> corners_;  // ascending
};

}  // namespace palpate::bake
