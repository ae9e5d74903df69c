// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/support_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_bake/metrics/support_area_grown.hpp"
#include "host_bake/metrics/vector.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

constexpr double kLeastProjectedEdge = 1e-7;

std::array<Vec3d, 3> corners(const NormalMesh& mesh, const Face& face) {
  return {vec(mesh.points[face[0]]), vec(mesh.points[face[1]]), vec(mesh.points[face[2]])};
}

double angle_between(Vec3d a, Vec3d b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

std::vector<double> one_ring_areas(const NormalMesh& mesh, const std::vector<Vec3d>& normals,
                                   double delta_rel) {
  std::vector<double> areas(mesh.points.size(), 0.0);
  for (const Face& face : mesh.faces) {
    const auto p = corners(mesh, face);
    const Vec3d area_vector = 0.5 * cross(p[1] - p[0], p[2] - p[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d n = normals[face[i]];
      const double projected = dot(area_vector, n);
      if (projected <= 0) continue;
      const std::array<double, 3> heights{0, dot(p[(i + 1) % 3] - p[i], n),
                                          dot(p[(i + 2) % 3] - p[i], n)};
      areas[face[i]] += projected * share_within(heights, delta_rel);
    }
  }
  return areas;
}

// Floor of D: kLeastSupportShare of the mean area around a vertex.
double least_area(const NormalMesh& mesh) {
  std::vector<char> used(mesh.points.size(), 0);
  double incident_area = 0;
  for (const Face& face : mesh.faces) {
    const auto p = corners(mesh, face);
    incident_area += 1.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
    for (const std::uint32_t v : face) used[v] = 1;
  }
  const auto vertices = std::count(used.begin(), used.end(), 1);
  return std::max(
      kLeastSupportShare * incident_area / static_cast<double>(std::max<long>(vertices, 1)),
      static_cast<double>(image::kMinArea));
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
                                 double delta_rel, SupportReading reading) {
  std::vector<double> areas = reading == SupportReading::one_ring
                                  ? one_ring_areas(mesh, normals, delta_rel)
                                  : grown_areas(mesh, normals, delta_rel);
  const double floor = least_area(mesh);
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
