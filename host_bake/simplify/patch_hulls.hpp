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
  refused,  ///< no interior, but the patch does not fill it
};

/// Builds hulls of shapes, with the scratch that takes.
class HullBuilder {
 public:
  explicit HullBuilder(const Surface& surface) : surface_(surface) {}

  /// The hull of all points of a shape. O(n) expected for convex patches.
  HullKind build(const PatchShape& shape, const Ring* ring, ShapeGatherer& gatherer,
                 ShrunkHull& out_hull);

  /// The hull of the points alone; empty where flat.
  HullKind build(std::span<const PointF> points, ShrunkHull& out_hull);

 private:
  [[nodiscard]] bool start(std::span<const PointF> points, std::span<const Triangle> faces);
  void insert_all(std::size_t points);
  void insert_walking(const PatchShape& shape, const std::vector<std::uint32_t>& order);
  [[nodiscard]] bool fills_polygon(const PatchShape& shape, const Ring* ring,
                                   ShapeGatherer& gatherer);

  const Surface& surface_;
  std::vector<PointF> points_;  // what hull_ spans
  std::optional<GrowingHull> hull_;
};

}  // namespace palpate::bake
