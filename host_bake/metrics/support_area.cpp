// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/support_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_bake/metrics/vector.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

constexpr double kLeastProjectedEdge = 1e-7;

std::array<Vec3d, 3> corners(const NormalMesh& mesh, const Face& face) {
  return {vec(mesh.points[face[0]]), vec(mesh.points[face[1]]), vec(mesh.points[face[2]])};
}

double angle_between(Vec3d a, Vec3d b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

// Share of the triangle (o, b, c) with heights 0, hb, hc over the plane through o that lies at
// heights up to `limit`.
double share_below(double hb, double hc, double limit) {
  if (hb > hc) std::swap(hb, hc);
  if (hc <= limit) return 1;
  // With one corner above the limit, what is cut off is a triangle at that corner; with two, what
  // stays is one at o.
  if (hb >= limit) return hb > 0 ? limit / hb * (limit / hc) : 0;
  const double from_o = (hc - limit) / hc;
  const double from_b = (hc - limit) / (hc - hb);
  return 1 - from_o * from_b;
}

// Share of the triangle within `limit` of the plane through o on both sides.
double share_within(double hb, double hc, double limit) {
  return share_below(hb, hc, limit) + share_below(-hb, -hc, limit) - 1;
}

}  // namespace

std::vector<Vec3d> vertex_normals(const NormalMesh& mesh) {
  std::vector<Vec3d> normals(mesh.points.size());
  for (const Face& face : mesh.faces) {
    const auto p = corners(mesh, face);
    const Vec3d normal = unit(cross(p[1] - p[0], p[2] - p[0]));
    for (std::size_t i = 0; i < 3; ++i) {
      normals[face[i]] += angle_between(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]) * normal;
    }
  }
  for (Vec3d& n : normals) n = unit(n);
  return normals;
}

std::vector<float> support_areas(const NormalMesh& mesh, const std::vector<Vec3d>& normals,
                                 double delta_rel) {
  std::vector<double> areas(mesh.points.size(), 0.0);
  std::vector<char> used(mesh.points.size(), 0);
  double incident_area = 0;
  for (const Face& face : mesh.faces) {
    const auto p = corners(mesh, face);
    const Vec3d area_vector = 0.5 * cross(p[1] - p[0], p[2] - p[0]);
    incident_area += 3 * norm(area_vector);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d n = normals[face[i]];
      const double projected = dot(area_vector, n);
      used[face[i]] = 1;
      if (projected <= 0) continue;
      const double hb = dot(p[(i + 1) % 3] - p[i], n), hc = dot(p[(i + 2) % 3] - p[i], n);
      areas[face[i]] += projected * share_within(hb, hc, delta_rel);
    }
  }
  const auto vertices = std::count(used.begin(), used.end(), 1);
  const double floor = std::max(
      kLeastSupportShare * incident_area / static_cast<double>(std::max<long>(vertices, 1)),
      static_cast<double>(image::kMinArea));
  std::vector<float> out(areas.size());
  std::transform(areas.begin(), areas.end(), out.begin(),
                 [&](double area) { return static_cast<float>(std::max(area, floor)); });
  return out;
}

float finest_resolution(const NormalMesh& mesh, const std::vector<Vec3d>& normals) {
  double least = 2;
  for (const Face& face : mesh.faces) {
    const auto p = corners(mesh, face);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const Vec3d edge = p[j] - p[i];
      const Vec3d n = unit(normals[face[i]] + normals[face[j]]);
      least = std::min(least, norm(edge - dot(edge, n) * n));
    }
  }
  return static_cast<float>(1 / std::max(least, kLeastProjectedEdge));
}

}  // namespace palpate::bake
