// SPDX-License-Identifier: GPL-3.0-or-later
// Exact predicates on float points, by CGAL alone: what is proved with them does not rest on the
// predicates that built the hulls.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "host_bake/hull/hull.hpp"

namespace palpate::bake {

using ExactKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

inline ExactKernel::Point_3 exact(const PointF& p) { return {p[0], p[1], p[2]}; }

/// 1 where p is above the plane of a, b, c (counter-clockwise seen from above), 0 on it, -1 below.
inline int side_of_plane(const PointF& a, const PointF& b, const PointF& c, const PointF& p) {
  return CGAL::orientation(exact(a), exact(b), exact(c), exact(p));
}

}  // namespace palpate::bake
