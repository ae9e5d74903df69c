// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/support_area_grown.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "host_bake/base/parallel.hpp"
#include "host_bake/metrics/vector.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {
namespace {

// What a visit to a face needs, in one cache line.
struct FloodFace {
  Vec3d area_vector;
  std::array<std::uint32_t, 3> corners{};
  std::array<std::uint32_t, 3> across{};  // side i runs from corner i to the next
};

struct Marks {
  std::vector<std::uint32_t> last_vertex;  // of each face: the last vertex, plus one, that met it
  std::vector<std::uint32_t> open;         // faces to visit
};

class Flood {
 public:
  Flood(const NormalMesh& mesh, double delta_rel)
      : mesh_(mesh), delta_(delta_rel), faces_(mesh.faces.size()) {
    const std::vector<std::uint32_t> twin = Surface(mesh).twin;
    first_.assign(mesh.points.size() + 1, 0);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      FloodFace& face = faces_[f];
      face.corners = mesh.faces[f];
      const Vec3d a = point(face.corners[0]);
      face.area_vector = 0.5 * cross(point(face.corners[1]) - a, point(face.corners[2]) - a);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t t = twin[3 * f + i];
        face.across[i] = t == kNothing ? kNothing : t / 3;
        ++first_[face.corners[i] + 1];
      }
    }
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    incident_.resize(3 * faces_.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      for (const std::uint32_t v : faces_[f].corners) incident_[next[v]++] = f;
    }
  }

  [[nodiscard]] double area(std::uint32_t vertex, Vec3d normal, Marks& marks) const {
    marks.last_vertex.resize(faces_.size(), 0);
    const auto meet = [&](std::uint32_t f) {
      if (f == kNothing || marks.last_vertex[f] == vertex + 1) return;
      marks.last_vertex[f] = vertex + 1;
      marks.open.push_back(f);
    };
    for (std::uint32_t i = first_[vertex]; i < first_[vertex + 1]; ++i) meet(incident_[i]);
    const Vec3d origin = point(vertex);
    double area = 0;
    while (!marks.open.empty()) {
      const FloodFace& face = faces_[marks.open.back()];
      marks.open.pop_back();
      const double projected = dot(face.area_vector, normal);
      if (projected <= 0) continue;
      std::array<double, 3> heights{};
      std::array<int, 3> beyond{};  // 1 above the slab, -1 below it
      for (std::size_t i = 0; i < 3; ++i) {
        heights[i] = dot(point(face.corners[i]) - origin, normal);
        beyond[i] = std::abs(heights[i]) <= delta_ ? 0 : heights[i] > 0 ? 1 : -1;
      }
      const bool within = beyond == std::array<int, 3>{};
      area += within ? projected : projected * share_within(heights, delta_);
      for (std::size_t i = 0; i < 3; ++i) {
        if (beyond[i] == 0 || beyond[i] != beyond[(i + 1) % 3]) meet(face.across[i]);
      }
    }
    return area;
  }

 private:
  [[nodiscard]] Vec3d point(std::uint32_t v) const { return vec(mesh_.points[v]); }

  const NormalMesh& mesh_;
  double delta_;
  std::vector<FloodFace> faces_;
  std::vector<std::uint32_t> first_, incident_;  // faces of vertex v: from first_[v] on
};

}  // namespace

std::vector<double> grown_areas(const NormalMesh& mesh, const std::vector<Vec3d>& normals,
                                double delta_rel) {
  const Flood flood(mesh, delta_rel);
  tbb::enumerable_thread_specific<Marks> marks;
  std::vector<double> areas(mesh.points.size());
  parallel_for(areas.size(), [&](std::size_t v) {
    areas[v] = flood.area(static_cast<std::uint32_t>(v), normals[v], marks.local());
  });
  return areas;
}

}  // namespace palpate::bake
