// SPDX-License-Identifier: GPL-3.0-or-later
// A body that holds a large patch's hull while the patch changes, at the cost of what changes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/simplify/lazy_hull.hpp"
#include "host_bake/simplify/patch_hulls.hpp"

namespace palpate::bake {

/// The hull of a patch as it once was, and of every vertex the patch has got since. Vertices that
/// go leave it as it is, so it may be larger than the patch's hull, never smaller.
///
/// It is the union of that first hull and parts, one for each growth: the hull of the facets that
/// the new vertex saw, of the vertex, and of an inner point, so that what rests on those facets is
/// inside.
///
/// Faces that enter the body, but not the patch's hull, are its guests. What keeps a guest out of
/// the hull does so until the patch gets a vertex beyond it.
class OuterHull {
 public:
  struct Guest {
    std::uint32_t face;
    std::vector<BoundingPlane> keepers;  ///< as LazyHull gives them

    /// What keeps it out does so with this point, too.
    [[nodiscard]] bool stays_out(const PointF& p) const;
  };
  struct Part {
    ShrunkHull hull;
    FaceBox grown;  ///< where it may reach beyond the body before
  };

  /// Begins with the hull of a shape. Of use where that is solid. O(n log n).
  HullKind build(const PatchShape& shape, ShapeGatherer& gatherer, ShrunkHull& out_hull);

  /// Time to begin anew: there is no room, or asking all parts and guests costs more.
  [[nodiscard]] bool full() const;
  /// For one more point.
  [[nodiscard]] bool has_room() const { return builder_.has_room(); }

  /// Grows to hold p; the new part, or nullptr where p is in the body. O(facets that p sees, and
  /// the square root of all).
  Part* grow(const PointF& p, HullBuilder& scratch);
  /// Makes the growth since the last keep() final, or undoes it.
  void keep();
  void take_back();

  /// Some part of the triangle enters a part; the first hull is not asked.
  [[nodiscard]] bool parts_entered_by(const std::array<PointF, 3>& triangle);

  /// With the next keep() the face is a guest, in the place of what it was before.
  void admit(std::uint32_t face, std::vector<BoundingPlane> keepers);
  [[nodiscard]] std::span<const Guest> guests() const { return guests_; }

 private:
  HullBuilder builder_;
  PointF inner_{};
  std::size_t most_parts_ = 0;
  std::vector<Part> parts_;
  std::size_t kept_ = 0;  // parts
  std::vector<Guest> guests_, admitted_;
  std::vector<PointF> points_;
};

}  // namespace palpate::bake
