// SPDX-License-Identifier: GPL-3.0-or-later
// Discrete oriented polytopes of 26 sides: how wide a point set is in 13 directions, a cheap
// stand-in for its hull. Source: Klosowski, Held, Mitchell, Sowizral, Zikan, Efficient collision
// detection using bounding volume hierarchies of k-DOPs, 1998 (directions: axes, face diagonals,
// space diagonals of the cube).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "host_bake/hull/hull.hpp"

namespace palpate::bake {

inline constexpr std::size_t kDopDirections = 13;

/// Extent along each direction (unit vectors; the first three are the axes).
struct Dop {
  std::array<double, kDopDirections> low;
  std::array<double, kDopDirections> high;
};

/// Of at least one point. O(points).
Dop dop_of(std::span<const PointF> points);

/// Of the union of what the two hold.
Dop united(const Dop& a, const Dop& b);

/// Width averaged over the directions: of a convex set, close to its mean width, which grows with
/// every set that it is in and hardly changes when the set is turned.
double mean_width(const Dop& dop);

}  // namespace palpate::bake
