// SPDX-License-Identifier: Apache-2.0
// Where two hulls that meet at their faces carry each other.
#pragma once

#include "rt_core/convex/minkowski.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::convex {

/// Hulls of more vertices have small faces: no centre is sought.
inline constexpr std::uint32_t kMostCarrying = image::kAdjacencyAbove;
/// Faces of a hull that carry, at most: where more come within reach, it is taken to end there.
inline constexpr std::uint32_t kMostFacets = 16;

/// Working memory of one query at a time, about 8 KB; needs no initialisation.
struct PressureScratch {
  /// Seen along the normal, from the middle.
  struct Corner {
    double x, y;
    double height;  ///< above the hull's lowest vertex, away from the other hull
  };
  template <std::uint32_t kMost>
  struct Corners {
    Corner at[kMost];
    std::uint32_t count;

    /// Only rounding, in a corner of no size, brings more than there is room for.
    void add(const Corner& c) noexcept {
      if (count < kMost) at[count++] = c;
    }
  };
  /// A face, with all vertices in its plane.
  struct Facet {
    double slope_x, slope_y, at_0;  ///< its height
    std::uint32_t members;          ///< bits of vertices
    std::uint32_t count;            ///< of its corners
    std::uint32_t known_beyond;     ///< bits of edges, each from a corner to the next
    /// Corners, counter-clockwise; one more while it is drawn.
    std::uint8_t outline[kMostCarrying + 1];
  };
  /// A hull as the other one sees it.
  struct Side {
    Corners<kMostCarrying> vertices;
    Facet facets[kMostFacets];
    std::uint32_t facet_count;
  };
  using Polygon = Corners<2 * kMostCarrying + 2>;

  Side a, b;
  Polygon common, kept;
};

/// In the coordinates of a.
struct PressureCentre {
  Vec3d at{};        ///< beside the middle of the closest points, across the normal
  double share = 0;  ///< how far the force acts there and not at the closest points: 0 where hulls
                     ///< have more than kMostCarrying vertices or nothing is left; less than 1
                     ///< where from its lowest vertex a hull rises by 1/16 and more everywhere, 0
                     ///< from 1/8 on: the centre is then no farther off than a few times the reach
};

/// The centre of pressure of an elastic foundation between two hulls: of what is left of `reach`
/// between their faces, seen along the normal, the mean place weighted by how much is left there.
///
/// A pair of closest points says where a face lies on a face no better than anywhere on it, and
/// leaps from edge to edge as the hulls rock on each other: the torque of a force there does so
/// too. This is the middle of the common part where they are parallel, and moves to the side that
/// comes nearer, so that a force k * reach there sets them back by the torque k * I of what they
/// are turned, I the second moment of the common part per area. Continuous in the poses, the normal
/// and the reach. Faces that rise by 1/4 to 1/2 and more do not carry: what is within reach of a
/// wall is narrow.
/// @param normal  unit, from b to a, in the coordinates of a
/// @param reach   how much farther apart, along the normal, the hulls would carry no more
/// @param middle  of the closest points, in the coordinates of a
/// Cost: some vertices * facets of either, and facets of one * facets of the other. Real-time safe.
[[nodiscard]] PressureCentre centre_of_pressure(const HullPair& pair, Vec3d normal, double reach,
                                                Vec3d middle, PressureScratch& scratch) noexcept;

}  // namespace palpate::convex
