// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/checks.hpp"

namespace palpate::image::checks {
namespace {

// Surfaces may be without convex edges, and vertices without normals.
bool sections_there(const ImageView& image) noexcept {
  if (image.surface_vertices.empty()) {
    return image.vertex_normals.empty() && image.surface_edges.empty() &&
           image.surface_runs.empty() && image.triangle_vertices.empty();
  }
  return !image.regions.empty() && !image.surface_runs.empty() && !image.triangle_vertices.empty();
}

bool runs_tile(const ImageView& image) noexcept {
  std::uint64_t next_vertex = 0;
  std::uint64_t next_edge = 0;
  for (const SurfaceRun& run : image.surface_runs) {
    if (run.first_vertex != next_vertex || run.first_edge != next_edge) return false;
    next_vertex += run.vertices;
    next_edge += run.edges;
  }
  return next_vertex == image.surface_vertices.size() && next_edge == image.surface_edges.size();
}

bool normals_tile(const ImageView& image) noexcept {
  std::uint64_t next = 0;
  for (const SurfaceVertex& v : image.surface_vertices) {
    if (v.first_normal != next) return false;
    next += std::uint64_t{v.hull_normals} + v.concave_normals;
  }
  return next == image.vertex_normals.size();
}

// Vertices that no triangle names must not lead astray either.
bool positions_sound(const ImageView& image) noexcept {
  for (std::uint32_t r = 0; r < image.surface_runs.size(); ++r) {
    const SurfaceRun& run = image.surface_runs[r];
    const double reach = static_cast<double>(image.regions[r].reach);
    for (const SurfaceVertex& v : image.surface_vertices.subspan(run.first_vertex, run.vertices)) {
      if (!within(squared_length(v.position), 0.0, reach * reach)) return false;
    }
  }
  return true;
}

bool corners_agree(const ImageView& image) noexcept {
  for (std::size_t t = 0; t < image.triangle_vertices.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = image.triangle_vertices[t].corner[c];
      if (v >= image.surface_vertices.size()) return false;
      const float* position = image.surface_vertices[v].position;
      const float* corner = image.region_triangles[t].corners + 3 * c;
      for (std::size_t k = 0; k < 3; ++k) {
        if (position[k] != corner[k]) return false;
      }
    }
  }
  return true;
}

// Edges between two triangles, of which theirs is the first, in ascending order within a region.
bool edge_sound(const ImageView& image, std::uint32_t region, std::uint32_t edge) noexcept {
  const std::uint32_t triangle = edge / 3;
  if (triangle >= image.region_triangles.size()) return false;
  const RegionTriangle& t = image.region_triangles[triangle];
  const std::uint32_t across = t.neighbours[edge % 3];
  return t.region == region && across != kNone && triangle < across;
}

bool edges_sound(const ImageView& image) noexcept {
  for (std::uint32_t r = 0; r < image.surface_runs.size(); ++r) {
    const SurfaceRun& run = image.surface_runs[r];
    for (std::uint32_t i = 0; i < run.edges; ++i) {
      const std::uint32_t edge = image.surface_edges[run.first_edge + i];
      if (!edge_sound(image, r, edge)) return false;
      if (i > 0 && edge <= image.surface_edges[run.first_edge + i - 1]) return false;
    }
  }
  return true;
}

// Whether two corners of a hull are so far from the same and from opposite that the arc between
// them has a direction.
bool arc_sound(const SurfaceNormal& from, const SurfaceNormal& to) noexcept {
  constexpr double kLeastSine2 = 1e-12;
  const auto& a = from.xyz;
  const auto& b = to.xyz;
  double sine2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    const double part = static_cast<double>(a[k]) * static_cast<double>(b[l]) -
                        static_cast<double>(a[l]) * static_cast<double>(b[k]);
    sine2 += part * part;
  }
  return sine2 > kLeastSine2;
}

bool hull_sound(const ImageView& image, const SurfaceVertex& v) noexcept {
  const auto hull = image.vertex_normals.subspan(v.first_normal, v.hull_normals);
  for (std::size_t i = 0; i < hull.size() && hull.size() > 1; ++i) {
    if (!arc_sound(hull[i], hull[(i + 1) % hull.size()])) return false;
  }
  return true;
}

bool normals_sound(const ImageView& image) noexcept {
  for (const SurfaceNormal& n : image.vertex_normals) {
    if (!is_unit(n.xyz)) return false;
  }
  for (const SurfaceVertex& v : image.surface_vertices) {
    if (!is_unit_or_zero(v.pseudonormal) || !hull_sound(image, v)) return false;
  }
  for (const SurfaceRun& run : image.surface_runs) {
    if (!is_unit_or_zero(run.normal) || !within(run.normal_cos, -1.0f, 1.0f)) return false;
  }
  return true;
}

}  // namespace

Status check_surface(const ImageView& image) noexcept {
  if (!sections_there(image)) return Status::image_missing_section;
  if (image.surface_vertices.empty()) return Status::ok;
  if (image.surface_runs.size() != image.regions.size() ||
      image.triangle_vertices.size() != image.region_triangles.size()) {
    return Status::image_bad_section;
  }
  if (!runs_tile(image) || !normals_tile(image)) return Status::image_bad_index;
  if (!positions_sound(image)) return Status::image_bad_float;
  if (!corners_agree(image) || !edges_sound(image)) return Status::image_bad_index;
  return normals_sound(image) ? Status::ok : Status::image_bad_float;
}

}  // namespace palpate::image::checks
