// SPDX-License-Identifier: Apache-2.0
// The support area D of a contact's primitive (Sec. 5.4), at a witness.
#pragma once

#include <cstdint>

#include "rt_core/convex/distance.hpp"
#include "rt_core/convex/hull.hpp"

namespace palpate::levels {

/// A witness of a query is a convex combination of the vertices of one of its simplices.
struct Combination {
  const std::uint32_t (&vertices)[3];  ///< [count] of the hull
  const double (&weights)[3];          ///< [count] > 0, sum 1
  std::uint32_t count = 0;             ///< 1 to 3
};

/// Vertices nearer to a face's plane than this are of the face; hull coordinates. Some times what a
/// query of hulls of one size tells apart.
inline constexpr double kFlat = 10 * convex::kDistanceGap;

/// D at a witness, relative to its body's radius squared, between the least and the largest D of
/// the hull's vertices: interpolated linearly between the vertices of the triangle it lies in.
/// Departure: a face of more than three vertices has many such triangles, and which of them a query
/// ends with is rounding. Its triangles here are those that meet at its vertex of the lowest index,
/// so that D is a continuous function of the witness alone; but a witness that its query puts on
/// the line between two vertices is left to these, be that line a diagonal of a face. Finite for
/// hulls of no baker too (vertices that coincide).
/// Cost: the neighbours of three vertices where the witness lies inside a face (where the hull has
/// no lists of them, its vertices), and its vertices, twice, where that face has more than three.
/// No memory. Real-time safe.
[[nodiscard]] double support_area(const convex::Hull& hull, const Combination& witness) noexcept;

}  // namespace palpate::levels
