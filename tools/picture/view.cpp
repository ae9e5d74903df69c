// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/view.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace palpate::picture {
namespace {

constexpr double kEdge_px = 0.75;   // of each of the two faces
constexpr double kEdgeShade = 0.5;  // of the face, where it is fully outlined
constexpr double kAmbient = 0.3;    // of a face seen from the side

Vec3d unit(Vec3d v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3d{};
}

// Least height of the triangle on the screen.
double height_px(const std::array<Corner, 3>& c) {
  double area_2 = 0, longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &a = c[i], &b = c[(i + 1) % 3];
    area_2 += a.x * b.y - b.x * a.y;
    longest = std::max(longest, std::hypot(b.x - a.x, b.y - a.y));
  }
  return longest > 0 ? std::abs(area_2) / longest : 0;
}

}  // namespace

View view_from(Vec3d from) {
  const double largest = std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)});
  assert(largest > 0 && std::isfinite(largest));
  View view;
  // Divided first, so that squares neither overflow nor vanish.
  view.toward = unit({from.x / largest, from.y / largest, from.z / largest});
  const bool upright = std::hypot(view.toward.x, view.toward.y) < 1e-6;
  view.right = unit(cross(upright ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, view.toward));
  view.up = cross(view.toward, view.right);
  return view;
}

Bounds bounds_of(const View& view, std::span<const Vec3f> points) {
  assert(!points.empty());
  Bounds bounds;
  for (const Vec3f& point : points) {
    const double x = dot(vec_cast<double>(point), view.right),
                 y = dot(vec_cast<double>(point), view.up);
    const Bounds one = {x, x, y, y};
    bounds = &point == points.data() ? one : united(bounds, one);
  }
  return bounds;
}

Bounds united(const Bounds& a, const Bounds& b) {
  return {std::min(a.left, b.left), std::max(a.right, b.right), std::min(a.bottom, b.bottom),
          std::max(a.top, b.top)};
}

void draw(Raster& raster, const View& view, const Bounds& bounds, const Surface& surface) {
  constexpr double kLeast = 1e-3;  // a straight surface seen from its end has no extent
  const double scale = std::min(raster.width / std::max(bounds.right - bounds.left, kLeast),
                                raster.height / std::max(bounds.top - bounds.bottom, kLeast));
  std::vector<Corner> corners;
  corners.reserve(surface.points.size());
  for (const Vec3f& point : surface.points) {
    const Vec3d p = vec_cast<double>(point);
    corners.push_back(
        {raster.width / 2.0 + scale * (dot(p, view.right) - (bounds.left + bounds.right) / 2),
         raster.height / 2.0 - scale * (dot(p, view.up) - (bounds.bottom + bounds.top) / 2),
         dot(p, view.toward)});
  }
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto& [a, b, c] = surface.faces[f];
    const Vec3d origin = vec_cast<double>(surface.points[a]);
    const Vec3d normal = unit(cross(vec_cast<double>(surface.points[b]) - origin,
                                    vec_cast<double>(surface.points[c]) - origin));
    const double light =
        kAmbient + (1 - kAmbient) * std::min(std::abs(dot(normal, view.toward)), 1.0);
    const std::array<Corner, 3> triangle = {corners[a], corners[b], corners[c]};
    const Rgb face = dimmed(surface.colours[f], light);
    const double outlined = std::clamp(
        (height_px(triangle) - kMinOutlined_px) / (kFullyOutlined_px - kMinOutlined_px), 0.0, 1.0);
    const Rgb edge = dimmed(face, 1 - (1 - kEdgeShade) * outlined);
    fill_triangle(raster, triangle, {face, edge, kEdge_px});
  }
}

}  // namespace palpate::picture
