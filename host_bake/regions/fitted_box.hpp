// SPDX-License-Identifier: GPL-3.0-or-later
// A small oriented box about points, conservative in float.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

/// Every point x given to fit_box() has |axis_k . (x - centre)| <= half[k], in exact arithmetic on
/// these floats; the axes are orthonormal to rounding.
struct FittedBox {
  std::array<float, 3> centre{};
  std::array<std::array<float, 3>, 3> axes{};
  std::array<float, 3> half{};
};

/// The box of least surface among several directions: the principal axes, and boxes with one axis
/// along their least one or along `normal`, turned about it in steps. The best of them is then
/// turned about its own axes by ever less, as long as that makes it smaller. Surface and not
/// volume, because most point sets are nearly flat.
/// @param points  at least one, within the unit ball (up to rounding)
/// @param normal  of the surface that the points are of, any length; zero where there is none
/// @param edges   further directions to try across `normal`, of the only triangle that the points
///                are of; its box lies along one of them, and is not turned further
/// O(points): directions are compared on at most 256 of them.
FittedBox fit_box(std::span<const Vec3d> points, Vec3d normal, std::span<const Vec3d> edges);

}  // namespace palpate::bake
