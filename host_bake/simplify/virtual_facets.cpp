// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/virtual_facets.hpp"

#include <algorithm>
#include <cstddef>

#include "host_bake/decompose/flat_cover.hpp"
#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {
namespace {

constexpr double kClear = 1e-9;  // beyond what normals of slivers are wrong by

Triangle least_first(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

}  // namespace

void VirtualFacets::set(const PatchShape& shape, const GrowingHull& hull) {
  std::vector<Triangle> real;
  real.reserve(shape.corners.size());
  for (const Triangle& t : shape.corners) real.push_back(least_first(t));
  std::sort(real.begin(), real.end());
  planes_.clear();
  corners_.clear();
  for (const GrowingHull::Facet& facet : hull.slots()) {
    const Triangle& t = facet.vertices;
    if (!facet.alive || std::binary_search(real.begin(), real.end(), least_first(t))) continue;
    const Vec3d a = position(shape.points[t[0]]);
    const Vec3d n = cross(position(shape.points[t[1]]) - a, position(shape.points[t[2]]) - a);
    const Vec3d normal = (1 / norm(n)) * n;
    planes_.push_back({normal, dot(normal, a)});
    for (const std::uint32_t v : t) corners_.push_back(shape.vertices[v]);
  }
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
}

bool VirtualFacets::has_corner(std::uint32_t vertex) const {
  return std::binary_search(corners_.begin(), corners_.end(), vertex);
}

bool VirtualFacets::clearly_below(const PointF& p) const {
  const Vec3d at = position(p);
  return std::all_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    return dot(plane.normal, at) - plane.offset < -kClear;
  });
}

bool VirtualFacets::separate(const std::array<PointF, 3>& triangle) const {
  return std::any_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    return std::all_of(triangle.begin(), triangle.end(), [&](const PointF& p) {
      return dot(plane.normal, position(p)) - plane.offset > -kShrink_rel;
    });
  });
}

}  // namespace palpate::bake
