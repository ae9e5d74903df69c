// SPDX-License-Identifier: GPL-3.0-or-later
// Exact signs of orientation determinants of float points: a floating-point filter (Shewchuk 1997,
// "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", stage A),
// then CGAL's exact predicates where the filter cannot tell.
#pragma once

#include "host_bake/hull/hull.hpp"

namespace palpate::bake {

/// Sign of ((b - a) x (c - a)) . (d - a): +1 where d lies strictly above the plane of a, b, c
/// (counter-clockwise seen from above), 0 where the four are coplanar.
int orient_3d(const PointF& a, const PointF& b, const PointF& c, const PointF& d);

/// The coordinate plane that remains when one axis is dropped: 0 gives (y, z), 1 (z, x), 2 (x, y).
using Axis = int;

/// +1 where a, b, c turn left in the coordinate plane seen against the dropped axis, 0 where they
/// are in line there. It is the sign of that component of (b - a) x (c - a).
int orient_2d(const PointF& a, const PointF& b, const PointF& c, Axis dropped);

/// All three on one line (or at one point).
bool collinear(const PointF& a, const PointF& b, const PointF& c);

/// A view along a coordinate axis in which a plane keeps its area.
struct Projection {
  Axis dropped = 2;
  int facing =
      0;  ///< +1 where the plane's normal points along the axis, -1 against it, 0: no plane
};

/// The view that shows the triangle a, b, c largest; facing is 0 where the three are collinear.
Projection projection_of(const PointF& a, const PointF& b, const PointF& c);

/// Orientation within a plane, counter-clockwise seen from above the plane that `view` is of.
inline int turn(const PointF& a, const PointF& b, const PointF& c, Projection view) {
  return view.facing * orient_2d(a, b, c, view.dropped);
}

}  // namespace palpate::bake
