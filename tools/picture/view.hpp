// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces seen from a direction, without perspective, lit by the viewer.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rt_core/geometry/vec3.hpp"
#include "tools/picture/raster.hpp"

namespace palpate::picture {

/// What the viewer calls right, up and nearer: orthonormal, in body axes.
struct View {
  Vec3d right, up, toward;
};

/// Seen from far away in this direction, with z up; with y up where that is the z axis.
/// @param from  finite, not zero
[[nodiscard]] View view_from(Vec3d from);

/// A triangle mesh. Faces are counter-clockwise seen from outside, but both sides are drawn.
struct Surface {
  std::span<const Vec3f> points;
  std::span<const std::array<std::uint32_t, 3>> faces;  ///< into points
  std::span<const Rgb> colours;                         ///< one a face
};

/// A rectangle of the plane that the viewer sees.
struct Bounds {
  double left = 0, right = 0, bottom = 0, top = 0;
};

/// The least one about the points. @param points  at least one
[[nodiscard]] Bounds bounds_of(const View& view, std::span<const Vec3f> points);
[[nodiscard]] Bounds united(const Bounds& a, const Bounds& b);

/// Draws the surface as large as `bounds` in the middle of the raster allows: faces flat, the
/// darker the more they turn away, outlined where they are more than kMinOutlined_px high, the
/// stronger the higher. O(points + faces + pixels covered).
void draw(Raster& raster, const View& view, const Bounds& bounds, const Surface& surface);

inline constexpr double kMinOutlined_px = 9, kFullyOutlined_px = 27;

}  // namespace palpate::picture
