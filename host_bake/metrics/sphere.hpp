// SPDX-License-Identifier: GPL-3.0-or-later
// Bounding spheres of hulls.
#pragma once

#include <span>

#include "host_bake/hull/hull.hpp"

namespace palpate::bake {

struct Sphere {
  PointF centre{};
  float radius = 0;
};

/// The smallest enclosing sphere, with its centre rounded to float and its radius rounded up so
/// that every point is inside both in exact arithmetic and where the distance is computed in float.
/// At least one point, inside the unit ball. O(points) expected.
Sphere bounding_sphere(std::span<const PointF> points);

}  // namespace palpate::bake
