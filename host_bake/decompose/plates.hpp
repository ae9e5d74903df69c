// SPDX-License-Identifier: GPL-3.0-or-later
// The bricks that patches are built of: faces joined to convex polygons as far as they lie in one
// plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/decompose/surface_edges.hpp"

namespace palpate::bake {

/// Every face is in one plate. A plate's faces lie in one plane, exactly, and fill a convex polygon
/// (fills_convex_polygon()); most plates are single faces. Without plates a patch could not grow
/// over a plane, because half a plane's faces are no convex polygon yet.
struct Plates {
  std::vector<std::uint32_t> of_face;
  std::vector<std::uint32_t> first_face;    ///< into faces; one more than there are plates
  std::vector<std::uint32_t> faces;         ///< ascending within a plate
  std::vector<std::uint32_t> first_corner;  ///< into corners; one more than there are plates
  std::vector<std::uint32_t>
      corners;              ///< extreme vertices, counter-clockwise; fewer than 3: no area
  std::vector<char> fixed;  ///< a patch of its own: crosses another face, or has no area

  [[nodiscard]] std::size_t size() const { return fixed.size(); }
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t plate) const {
    return {faces.data() + first_face[plate], first_face[plate + 1] - first_face[plate]};
  }
  [[nodiscard]] std::span<const std::uint32_t> corners_of(std::uint32_t plate) const {
    return {corners.data() + first_corner[plate], first_corner[plate + 1] - first_corner[plate]};
  }
};

/// A plane region that is one convex polygon becomes one plate; others are divided by joining
/// convex polygons over their longest edges first (Hertel and Mehlhorn 1983, from the triangles
/// that the mesh has). Faces without area join a plate on which they lie. crossing: of each face,
/// it stays alone; most_faces: of each face, the largest plate that it may belong to. O(n log n)
/// but for long borders of plane regions, see fills_convex_polygon().
Plates make_plates(const NormalMesh& mesh, const SurfaceEdges& edges,
                   const std::vector<char>& crossing, const std::vector<std::uint32_t>& most_faces);

}  // namespace palpate::bake
