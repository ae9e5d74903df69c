// SPDX-License-Identifier: GPL-3.0-or-later
// A patch copied out of the surface, as it is or as a collapse would leave it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/decompose/face_tree.hpp"
#include "host_bake/hull/facets.hpp"
#include "host_bake/simplify/patch_lists.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {

struct PatchShape {
  std::uint32_t patch = kNothing;
  std::vector<std::uint32_t> faces;     ///< of the surface
  std::vector<Triangle> corners;        ///< [faces] local vertices
  std::vector<PointF> points;           ///< of the local vertices
  std::vector<std::uint32_t> vertices;  ///< [points] of the surface
  std::vector<char> changed;            ///< [faces] has the new vertex as a corner
  std::uint32_t apex = kNothing;        ///< the new vertex, local
};

/// The points do not lie near a plane: their hull is far thicker than kShrink_rel. O(points).
bool clearly_solid(std::span<const PointF> points);

FaceBox box_of(std::span<const PointF> points);
FaceBox box_of(const PointF& a, const PointF& b, const PointF& c);

/// Copies patches. Scratch of the size of the surface, so that a copy costs its own size.
class ShapeGatherer {
 public:
  explicit ShapeGatherer(const Surface& surface);

  /// The union of patches; after the collapse of `ring` where given, the new vertex still where
  /// ring.kept is.
  void gather(const PatchLists& patches, std::span<const std::uint32_t> members, const Ring* ring,
              PatchShape& out_shape);

  /// The half-edge across h once `ring` has collapsed.
  [[nodiscard]] std::uint32_t twin_after(const Ring* ring, std::uint32_t h) const;

  /// For the shape gathered last or passed to index(): the position of a face in it; kNothing where
  /// it is not in it.
  [[nodiscard]] std::uint32_t place(std::uint32_t face) const {
    return face_mark_[face] == face_turn_ ? face_place_[face] : kNothing;
  }
  void index(const PatchShape& shape);

  /// Local faces, breadth-first over edges; first all that hang together with the first one, and so
  /// on. Indexes the shape.
  const std::vector<std::uint32_t>& walk(const PatchShape& shape, const Ring* ring);

 private:
  const Surface& surface_;
  std::vector<std::uint32_t> vertex_mark_, vertex_place_, face_mark_, face_place_;
  std::uint32_t vertex_turn_ = 0, face_turn_ = 0;
  std::vector<std::uint32_t> order_;
  std::vector<char> seen_;
};

}  // namespace palpate::bake
