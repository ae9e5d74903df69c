// SPDX-License-Identifier: GPL-3.0-or-later
// The hull of a patch and what it holds: constraint 3 of Sec. 4.3 seen from the hull.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_bake/decompose/shrunk_hull.hpp"
#include "host_bake/simplify/patch_shape.hpp"

namespace palpate::bake {

enum class HullKind : std::uint8_t {
  unknown,
  empty,    ///< no interior, and the patch fills it: nothing can enter
  solid,    ///< ask the ShrunkHull
  outer,    ///< the ShrunkHull holds the patch's hull, and nothing enters it so far
  refused,  ///< no interior, but the patch does not fill it
};

/// The box with room for kShrink_rel and the rounding of floats.
FaceBox with_margin(FaceBox box);

/// Builds hulls of shapes, with the scratch that takes.
class HullBuilder {
 public:
  /// The hull of all points of a shape. O(n) expected for convex patches.
  /// @param out_grown  where the hull's interior, shrunk, may reach beyond that of the hull without
  ///                   the new vertex; everywhere where the shape has no new vertex
  HullKind build(const PatchShape& shape, const Ring* ring, ShapeGatherer& gatherer,
                 ShrunkHull& out_hull, FaceBox& out_grown);

  /// The hull of the points alone; empty where flat.
  HullKind build(std::span<const PointF> points, ShrunkHull& out_hull);

  /// To the solid hull of a shape built last further points can be added, as long as there is room:
  /// at least as many as it has. add() gives the point and the corners of the facets that it saw;
  /// false where it is in the hull.
  [[nodiscard]] bool has_room() const { return used_ < points_.size(); }
  [[nodiscard]] bool add(const PointF& point, std::vector<PointF>& out_grown);
  /// Makes the points added since the last keep() final, or takes them away.
  void keep();
  void take_back();

 private:
  [[nodiscard]] bool start(std::span<const PointF> points, std::span<const Triangle> faces,
                           std::uint32_t without);
  void insert_all(std::size_t points, std::uint32_t without);
  void insert_walking(const PatchShape& shape, const std::vector<std::uint32_t>& order,
                      std::uint32_t without);
  void insert(const PatchShape& shape, const Ring* ring, ShapeGatherer& gatherer,
              std::uint32_t without);
  [[nodiscard]] bool insert_apex_last(const PatchShape& shape, const Ring* ring,
                                      ShapeGatherer& gatherer, FaceBox& out_grown);
  [[nodiscard]] bool fills_polygon(const PatchShape& shape, const Ring* ring,
                                   ShapeGatherer& gatherer);

  std::vector<PointF> points_;  // what hull_ spans
  std::uint32_t used_ = 0;      // of points_
  std::uint32_t kept_ = 0;      // of those
  std::optional<GrowingHull> hull_;
};

}  // namespace palpate::bake
