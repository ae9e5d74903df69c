// SPDX-License-Identifier: Apache-2.0
// Where two hulls that meet at their faces carry each other.
#pragma once

#include <cstdint>

#include "rt_core/convex/minkowski.hpp"

namespace palpate::convex {

/// Hulls of more vertices have small faces: no centre is sought.
inline constexpr std::uint32_t kMostCarrying = 128;
/// Faces of a hull that carry, at most: where more come within reach, it is taken to end there.
inline constexpr std::uint32_t kMostFacets = 16;
/// Edges of those that are looked beyond; likewise.
inline constexpr std::uint32_t kMostEdges = 256;

/// Working memory of one query at a time, about 25 KB; needs no initialisation.
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
  /// Some of a hull's vertices, or of a face's edges, each from a corner to the next.
  struct Set {
    std::uint32_t words[kMostCarrying / 32];

    void clear() noexcept { *this = {}; }
    void add(const Set& other) noexcept {
      for (std::uint32_t k = 0; k < kMostCarrying / 32; ++k) words[k] |= other.words[k];
    }
    void add(std::uint32_t i) noexcept { words[i / 32] |= 1u << i % 32; }
    [[nodiscard]] bool has(std::uint32_t i) const noexcept {
      return (words[i / 32] >> i % 32 & 1u) != 0;
    }
  };
  /// A face, with all vertices in its plane.
  struct Facet {
    double slope_x, slope_y, at_0;  ///< its height
    Set members;
    Set known_beyond;     ///< edges
    std::uint32_t count;  ///< of its corners
    /// Corners, counter-clockwise; one more while it is drawn.
    std::uint8_t outline[kMostCarrying + 1];
  };
  /// A hull as the other one sees it.
  struct Side {
    Corners<kMostCarrying> vertices;  ///< that faces which carry can have; the lowest first
    Facet facets[kMostFacets + 1];    ///< one more tells that there are
    std::uint32_t facet_count;
  };
  using Polygon = Corners<2 * kMostCarrying + 2>;

  Side a, b;
  Polygon common, kept;
};

/// In the coordinates of a.
struct PressureCentre {
  Vec3d at{};  ///< beside the middle of the closest points, across the normal
  /// How far the force acts there and not at the closest points: 0 where hulls have more than
  /// kMostCarrying vertices or nothing is left; less than 1 where from its lowest vertex a hull
  /// rises by 1/25 and more everywhere, 0 from 1/10 on (the closest points are as good), and less
  /// where more than kMostFacets faces meet within a fiftieth of the reach.
  double share = 0;
};

/// The centre of pressure of an elastic foundation (Winkler's: Johnson, Contact Mechanics, 1985,
/// Sec. 4.3) between two hulls: of what is left of `reach`
/// between their faces, seen along the normal, the mean place weighted by how much is left there.
///
/// A pair of closest points says where a face lies on a face no better than anywhere on it, and
/// leaps from edge to edge as the hulls rock on each other: the torque of a force there does so
/// too. This is the middle of the common part where they are parallel, and moves to the side that
/// comes nearer, so that a force k * reach there sets them back by the torque k * I of what they
/// are turned, I the second moment of the common part per area. Continuous in the poses, the normal
/// and the reach. Faces that rise by 1/4 to 1/2 and more do not carry: what is within reach of a
/// wall is narrow.
/// Lengths are in the unit of the hulls' scales, which are of the order of 1: vertices within 1e-6
/// of a plane are in it.
/// @param normal  unit, from b to a, in the coordinates of a
/// @param reach   how much farther apart, along the normal, the hulls would carry no more
/// @param middle  of the closest points, in the coordinates of a
/// Cost: at most kMostEdges times the vertices of either hull, and kMostFacets squared pairs of
/// faces; a few microseconds for boxes and cylinders. Real-time safe.
[[nodiscard]] PressureCentre centre_of_pressure(const HullPair& pair, Vec3d normal, double reach,
                                                Vec3d middle, PressureScratch& scratch) noexcept;

}  // namespace palpate::convex
