// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/pack/patch_normal.hpp"

#include <algorithm>

#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {
namespace {

/// Twice the area long.
Vec3d normal_of(std::span<const PointF> points, const image::Triangle& t) {
  const Vec3d a = vec(points[t.vertices[0]]);
  return cross(vec(points[t.vertices[1]]) - a, vec(points[t.vertices[2]]) - a);
}

}  // namespace

PatchNormal patch_normal(std::span<const PointF> points,
                         std::span<const image::Triangle> triangles) {
  Vec3d sum{};
  double area = 0;
  for (const image::Triangle& t : triangles) {
    const Vec3d normal = normal_of(points, t);
    sum += normal;
    area += norm(normal);
  }
  PatchNormal out;
  if (!(area > 0) || !(norm(sum) > 0)) return out;
  const Vec3f mean = vec_cast<float>((1 / area) * sum);
  out.mean = {mean.x, mean.y, mean.z};
  const Vec3d axis = unit(sum);
  double least = 1;
  for (const image::Triangle& t : triangles) {
    const Vec3d normal = normal_of(points, t);
    if (norm(normal) > 0) least = std::min(least, dot(axis, unit(normal)));
  }
  out.least_cosine = static_cast<float>(std::max(least, -1.0));
  return out;
}

}  // namespace palpate::bake
