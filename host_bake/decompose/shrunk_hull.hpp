// SPDX-License-Identifier: GPL-3.0-or-later
// The interior of a patch's hull, and what enters it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_bake/decompose/face_tree.hpp"
#include "host_bake/hull/growing_hull.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// A hull with every plane moved inward by kShrink_rel. What has nothing left after clipping
/// against these planes touches the hull's surface at most.
///
/// In double arithmetic: normals of facets are good to 1e-15 relative, since differences of floats
/// and their products are almost always exact, so planes are far better than kShrink_rel.
class ShrunkHull {
 public:
  /// From a solid hull. O(facets).
  void build(const GrowingHull& hull);

  /// The centroid of the volume is less than kShrink_rel below some facet. Since a centroid is at
  /// least a quarter of the width deep (Minkowski), all hulls that vanish when shrunk are thin, and
  /// thin ones are less than 4 kShrink_rel thick.
  [[nodiscard]] bool thin() const { return thin_; }

  /// The point is in the hull (not shrunk). O(facets).
  [[nodiscard]] bool holds(Vec3d p) const;

  /// Surely nothing in the box enters. False decides nothing.
  [[nodiscard]] bool surely_outside(const FaceBox& box);

  /// Some part of the triangle enters. O(facets), mostly far less.
  [[nodiscard]] bool entered_by(Vec3d a, Vec3d b, Vec3d c);

 private:
  struct Plane {
    Vec3d normal;   // unit, outward
    double offset;  // of the shrunk plane
  };
  [[nodiscard]] bool small() const;
  [[nodiscard]] double height(std::uint32_t plane, Vec3d p) const {
    return dot(planes_[plane].normal, p) - planes_[plane].offset;
  }
  void find_planes(const GrowingHull& hull);
  void find_centre();
  [[nodiscard]] std::uint32_t step_toward(std::uint32_t facet, Vec3d ray, std::size_t turn) const;
  template <class Separates>
  bool find_separating(Vec3d middle, Separates separates);
  [[nodiscard]] bool clip_away(std::uint32_t plane);
  [[nodiscard]] bool cut_toward_centre();
  [[nodiscard]] bool cut_by_all();

  std::vector<Plane> planes_;
  std::vector<std::array<Vec3d, 3>> corners_;             // of the facet in each plane
  std::vector<std::array<std::uint32_t, 3>> neighbours_;  // as in the hull
  std::vector<std::uint32_t> plane_of_slot_;              // of the hull's slots
  FaceBox box_;
  Vec3d centre_{};
  bool thin_ = true;
  std::uint32_t last_ = 0;  // the plane that separated last: neighbours in space share it
  std::vector<Vec3d> polygon_, clipped_;
  std::vector<std::uint32_t> order_, visited_;
  std::uint32_t visit_ = 0;
};

}  // namespace palpate::bake
