// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/surface_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "host_bake/base/error.hpp"
#include "host_bake/base/parallel.hpp"
#include "host_bake/metrics/vector.hpp"
#include "host_bake/regions/normal_cone.hpp"
#include "host_bake/regions/surface_edge.hpp"
#include "rt_core/image/format.hpp"
#include "rt_core/image/triangle_normal.hpp"

namespace palpate::bake {
namespace {

constexpr double kCancelled = 1e-9;  // of angles: a shorter sum of normals has no direction

void copy_to(Vec3d from, float (&to)[3]) {
  const Vec3f v = vec_cast<float>(from);
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

/// A corner of a triangle, 3 * triangle + corner, as sides are named.
struct Corner {
  std::uint32_t vertex;
  std::uint32_t name;
};

/// What a vertex adds to the sections.
struct VertexNormals {
  Vec3d pseudonormal{};
  std::vector<Vec3d> hull;
  std::vector<Vec3d> concave;
};

class SurfaceBuilder {
 public:
  SurfaceBuilder(const NormalMesh& mesh, std::span<const image::RegionTriangle> triangles,
                 std::size_t regions, std::span<const std::size_t> crossing_faces)
      : mesh_(mesh), triangles_(triangles), regions_(regions), crosses_(mesh.faces.size()) {
    for (const std::size_t face : crossing_faces) crosses_.at(face) = 1;
  }

  SurfaceParts run() && {
    out_.runs.resize(regions_);
    number_vertices();
    list_edges();
    measure_vertices();
    store_normals();
    return std::move(out_);
  }

 private:
  /// Region by region, in the order of their first corners.
  void number_vertices() {
    std::vector<std::uint32_t> first(mesh_.points.size(), image::kNone);  // corner's name
    out_.triangle_vertices.resize(triangles_.size());
    for_each_corner([&](std::uint32_t name, std::uint32_t point) {
      if (first[point] == image::kNone) {
        first[point] = name;
        ++out_.runs[triangles_[name / 3].region].vertices;
      }
    });
    std::uint32_t next = 0;
    for (image::SurfaceRun& run : out_.runs) {
      run.first_vertex = next;
      next += run.vertices;
    }
    out_.vertices.resize(next);
    std::vector<std::uint32_t> at(regions_);
    std::vector<std::uint32_t> number(mesh_.points.size(), image::kNone);
    for_each_corner([&](std::uint32_t name, std::uint32_t point) {
      const std::uint32_t region = triangles_[name / 3].region;
      if (first[point] == name) {
        number[point] = out_.runs[region].first_vertex + at[region]++;
        std::copy_n(mesh_.points[point].begin(), 3, out_.vertices[number[point]].position);
      }
    });
    for_each_corner([&](std::uint32_t name, std::uint32_t point) {
      out_.triangle_vertices[name / 3].corner[name % 3] = number[point];
    });
  }

  template <class Visit>
  void for_each_corner(Visit visit) const {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const Face& face = mesh_.faces[triangles_[t].source];
      for (std::uint32_t c = 0; c < 3; ++c) visit(3 * t + c, face[c]);
    }
  }

  void list_edges() {
    std::vector<std::vector<std::uint32_t>> of_region(regions_);
    bends_.resize(3 * triangles_.size());
    for (std::uint32_t side = 0; side < bends_.size(); ++side) {
      bends_[side] = bend_of(triangles_, side);
      const image::RegionTriangle& t = triangles_[side / 3];
      if (bends_[side] == Bend::convex && side / 3 < t.neighbours[side % 3]) {
        of_region[t.region].push_back(side);
      }
    }
    for (std::size_t r = 0; r < regions_; ++r) {
      out_.runs[r].first_edge = static_cast<std::uint32_t>(out_.edges.size());
      out_.runs[r].edges = static_cast<std::uint32_t>(of_region[r].size());
      out_.edges.insert(out_.edges.end(), of_region[r].begin(), of_region[r].end());
    }
  }

  void measure_vertices() {
    std::vector<Corner> corners;
    corners.reserve(3 * triangles_.size());
    for (std::uint32_t name = 0; name < 3 * triangles_.size(); ++name) {
      corners.push_back({out_.triangle_vertices[name / 3].corner[name % 3], name});
    }
    std::stable_sort(corners.begin(), corners.end(),
                     [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
    std::vector<std::size_t> starts(out_.vertices.size() + 1, 0);
    for (const Corner& c : corners) ++starts[c.vertex + 1];
    for (std::size_t v = 0; v < out_.vertices.size(); ++v) starts[v + 1] += starts[v];
    measured_.resize(out_.vertices.size());
    parallel_for(out_.vertices.size(), [&](std::size_t v) {
      measured_[v] = normals_at(std::span(corners).subspan(starts[v], starts[v + 1] - starts[v]));
    });
  }

  VertexNormals normals_at(std::span<const Corner> corners) const {
    VertexNormals out;
    std::vector<Vec3d> all;
    std::vector<Vec3d> concave;
    for (const Corner& c : corners) {
      const std::uint32_t t = c.name / 3;
      const Vec3d normal = image::normal_of(triangles_[t]);
      if (normal == Vec3d{}) continue;
      out.pseudonormal += angle_at(t, c.name % 3) * normal;
      all.push_back(normal);
      const std::uint32_t before = 3 * t + (c.name + 2) % 3;  // the side that ends here
      if (bends_[c.name] == Bend::concave || bends_[before] == Bend::concave) {
        concave.push_back(normal);
      }
    }
    const bool has_inside = norm(out.pseudonormal) > kCancelled && !tells_no_inside(corners);
    out.pseudonormal = has_inside ? unit(out.pseudonormal) : Vec3d{};
    out.hull = spherical_hull(distinct_normals(all));
    out.concave = distinct_normals(concave);
    return out;
  }

  /// On a border, or of a face that crosses others.
  bool tells_no_inside(std::span<const Corner> corners) const {
    return std::ranges::any_of(corners, [&](const Corner& c) {
      const image::RegionTriangle& t = triangles_[c.name / 3];
      const std::uint32_t i = c.name % 3;
      return t.neighbours[i] == image::kNone || t.neighbours[(i + 2) % 3] == image::kNone ||
             crosses_[t.source] != 0;
    });
  }

  double angle_at(std::uint32_t t, std::uint32_t c) const {
    const Vec3d p = image::corner_of(triangles_[t], c);
    const Vec3d a = image::corner_of(triangles_[t], (c + 1) % 3) - p;
    const Vec3d b = image::corner_of(triangles_[t], (c + 2) % 3) - p;
    return std::atan2(norm(cross(a, b)), dot(a, b));
  }

  static void refuse_above(std::size_t value, std::size_t limit, const std::string& what,
                           const std::string& remedy) {
    if (value <= limit) return;
    throw InputRefused("the surface would pass a limit of the image format",
                       std::to_string(value) + " " + what + ", at most " + std::to_string(limit),
                       remedy);
  }

  void store_normals() {
    for (std::size_t v = 0; v < out_.vertices.size(); ++v) {
      const VertexNormals& from = measured_[v];
      refuse_above(std::max(from.hull.size(), from.concave.size()),
                   std::numeric_limits<std::uint16_t>::max(), "normals at one vertex",
                   "divide the fan of triangles around it");
      image::SurfaceVertex& to = out_.vertices[v];
      copy_to(from.pseudonormal, to.pseudonormal);
      to.first_normal = static_cast<std::uint32_t>(out_.normals.size());
      to.hull_normals = static_cast<std::uint16_t>(from.hull.size());
      to.concave_normals = static_cast<std::uint16_t>(from.concave.size());
      for (const Vec3d& n : from.hull) add_normal(n);
      for (const Vec3d& n : from.concave) add_normal(n);
    }
  }

  void add_normal(Vec3d n) {
    out_.normals.emplace_back();
    copy_to(n, out_.normals.back().xyz);
  }

  const NormalMesh& mesh_;
  std::span<const image::RegionTriangle> triangles_;
  std::size_t regions_;
  std::vector<char> crosses_;  // of each face
  std::vector<Bend> bends_;    // of each side
  std::vector<VertexNormals> measured_;
  SurfaceParts out_;
};

}  // namespace

SurfaceParts surface_parts(const NormalMesh& mesh, std::span<const image::RegionTriangle> triangles,
                           std::size_t regions, std::span<const std::size_t> crossing_faces) {
  return SurfaceBuilder(mesh, triangles, regions, crossing_faces).run();
}

void set_normal_cones(std::span<const image::RegionTriangle> triangles,
                      std::span<image::SurfaceRun> regions) {
  constexpr double kRoundedDown = 1e-6;
  std::vector<std::vector<Vec3d>> normals(regions.size());
  for (const image::RegionTriangle& t : triangles) {
    const Vec3d normal = image::normal_of(t);
    if (!(normal == Vec3d{})) normals[t.region].push_back(normal);
  }
  parallel_for(regions.size(), [&](std::size_t r) {
    const NormalCone cone = normal_cone(normals[r]);
    copy_to(cone.axis, regions[r].normal);
    regions[r].normal_cos =
        cone.axis == Vec3d{} ? -1.0f : static_cast<float>(cone.cosine - kRoundedDown);
  });
}

}  // namespace palpate::bake
