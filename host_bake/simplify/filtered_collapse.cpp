// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/filtered_collapse.hpp"

#include <algorithm>
#include <cstddef>

#include "host_bake/decompose/geometry.hpp"
#include "host_bake/simplify/relax.hpp"

namespace palpate::bake {
namespace {

constexpr double kLeastProjection = 1e-7;

/// ((b - a) x (c - a)) . (d - a): positive where d is above the plane of a, b, c.
double volume(Vec3d a, Vec3d b, Vec3d c, Vec3d d) { return dot(cross(b - a, c - a), d - a); }

}  // namespace

RingShape& gather(const Surface& surface, const Ring& ring, RingShape& shape) {
  shape.ring.clear();
  shape.far.clear();
  shape.has_far.clear();
  for (const std::uint32_t v : ring.vertices) shape.ring.push_back(position(surface.points[v]));
  for (const std::uint32_t h : ring.far) {
    shape.has_far.push_back(h == kNothing ? 0 : 1);
    shape.far.push_back(h == kNothing ? Vec3d{} : position(surface.points[surface.apex(h)]));
  }
  return shape;
}

FilterLine filter_from(Vec3d initial, const Ring& ring, const RingShape& shape) {
  if (!ring.closed) return {initial, initial};
  return {initial, relaxed(initial, shape.ring, shape.far, shape.has_far)};
}

double resolution(const Surface& surface, const Ring& ring, const RingShape& shape,
                  const FilterLine& line) {
  Vec3d normal{};
  for (std::size_t i = 0; i < ring.faces(); ++i) {
    const std::size_t j = i + 1 == shape.ring.size() ? 0 : i + 1;
    normal += cross(shape.ring[i] - line.goal, shape.ring[j] - line.goal);
  }
  const Vec3d edge = position(surface.points[ring.kept]) - position(surface.points[ring.removed]);
  const double length = norm(normal);
  if (length > 0) normal = (1 / length) * normal;
  return 1 / std::max(norm(edge - dot(edge, normal) * normal), kLeastProjection);
}

void restrict_to_negative(double at_goal, double at_initial, Feasible& part) {
  if (at_goal <= 0 && at_initial <= 0) return;
  if (at_goal > 0 && at_initial > 0) {
    part.low = 2;
    part.high = -1;
    return;
  }
  const double root = at_goal / (at_goal - at_initial);
  if (at_goal > 0) {
    part.low = std::max(part.low, root);
  } else {
    part.high = std::min(part.high, root);
  }
}

Feasible feasible_part(const Ring& ring, const RingShape& shape, const FilterLine& line,
                       std::span<const std::uint32_t> patch_of) {
  Feasible part;
  const std::size_t n = ring.faces();
  for (std::size_t i = 0; i < n && !part.empty(); ++i) {
    const std::uint32_t patch = patch_of[ring.spokes[i] / 3];
    const Vec3d a = shape.ring[i];
    const Vec3d b = shape.ring[i + 1 == shape.ring.size() ? 0 : i + 1];
    if (shape.has_far[i] && patch_of[ring.far[i] / 3] == patch)
      restrict_to_negative(volume(b, a, shape.far[i], line.goal),
                           volume(b, a, shape.far[i], line.initial), part);
    if (i == 0 && !ring.closed) continue;
    const std::size_t before = i == 0 ? n - 1 : i - 1;
    if (patch_of[ring.spokes[before] / 3] != patch) continue;
    const Vec3d c = shape.ring[before];
    // det(v, c, a, b) with v the new vertex; the same volume seen from the fixed triangle.
    restrict_to_negative(-volume(c, a, b, line.goal), -volume(c, a, b, line.initial), part);
  }
  return part;
}

}  // namespace palpate::bake
