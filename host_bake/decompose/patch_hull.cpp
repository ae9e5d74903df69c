// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/patch_hull.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "host_bake/decompose/geometry.hpp"
#include "host_bake/hull/facets.hpp"
#include "host_bake/hull/predicates.hpp"

namespace palpate::bake {
namespace {

constexpr double kCovered = 1 - 1e-9;  // areas are sums of doubles good to 1e-15 each

double twice_area(const NormalMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return norm(area_vector(mesh, {a, b, c}));
}

/// Which facets of a solid hull the plates of the patch cover.
class Coverage {
 public:
  Coverage(const NormalMesh& mesh, const FacetHull& hull)
      : mesh_(mesh), hull_(hull), area_(hull.facets, 0), covered_(hull.facets, 0) {
    const std::size_t vertices = hull.mesh.vertices.size();
    first_.assign(vertices + 1, 0);
    for (const Triangle& face : hull.mesh.faces)
      for (const std::uint32_t v : face) ++first_[v + 1];
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    faces_at_.resize(hull.mesh.faces.size() * 3);
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t f = 0; f < hull.mesh.faces.size(); ++f) {
      const Triangle& face = hull.mesh.faces[f];
      for (const std::uint32_t v : face) faces_at_[at[v]++] = f;
      area_[hull.facet_of_face[f]] +=
          twice_area(mesh, vertex(face[0]), vertex(face[1]), vertex(face[2]));
    }
  }

  void add(std::span<const std::uint32_t> corners) {
    const std::uint32_t face = face_under(corners);
    if (face == GrowingHull::kNone) return;
    double area = 0;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      area += twice_area(mesh_, corners[0], corners[i], corners[i + 1]);
    covered_[hull_.facet_of_face[face]] += area;
  }

  [[nodiscard]] bool covers(std::size_t face) const {
    const std::uint32_t facet = hull_.facet_of_face[face];
    return covered_[facet] >= kCovered * area_[facet];
  }

 private:
  [[nodiscard]] std::uint32_t vertex(std::uint32_t local) const {
    return hull_.mesh.vertices[local];
  }

  [[nodiscard]] bool in_plane(std::uint32_t face, std::span<const std::uint32_t> corners) const {
    const Triangle& local = hull_.mesh.faces[face];
    const Triangle f = {vertex(local[0]), vertex(local[1]), vertex(local[2])};
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::find(f.begin(), f.end(), corners[i]) != f.end()) continue;
      if (orient_3d(mesh_.points[f[0]], mesh_.points[f[1]], mesh_.points[f[2]],
                    mesh_.points[corners[i]]) != 0)
        return false;
    }
    return true;
  }

  /// A hull face in the plane of the corners: at a corner that is a hull vertex, or anywhere.
  [[nodiscard]] std::uint32_t face_under(std::span<const std::uint32_t> corners) const {
    const std::vector<std::uint32_t>& vertices = hull_.mesh.vertices;
    for (const std::uint32_t corner : corners) {
      const auto found = std::lower_bound(vertices.begin(), vertices.end(), corner);
      if (found == vertices.end() || *found != corner) continue;
      const auto v = static_cast<std::size_t>(found - vertices.begin());
      for (std::size_t i = first_[v]; i < first_[v + 1]; ++i)
        if (in_plane(faces_at_[i], corners)) return faces_at_[i];
      return GrowingHull::kNone;
    }
    for (std::uint32_t f = 0; f < hull_.mesh.faces.size(); ++f)
      if (in_plane(f, corners)) return f;
    return GrowingHull::kNone;
  }

  const NormalMesh& mesh_;
  const FacetHull& hull_;
  std::vector<std::uint32_t> first_, faces_at_;  // hull faces at each hull vertex
  std::vector<double> area_, covered_;           // twice, of each facet
};

/// Patch::vertices from hull.vertices of the mesh and the faces; makes hull.vertices local.
void list_vertices(const NormalMesh& mesh, Patch& patch) {
  std::vector<std::uint32_t> all;
  for (const std::uint32_t f : patch.faces)
    all.insert(all.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  patch.vertices = patch.hull.vertices;
  std::set_difference(all.begin(), all.end(), patch.hull.vertices.begin(),
                      patch.hull.vertices.end(), std::back_inserter(patch.vertices));
  std::iota(patch.hull.vertices.begin(), patch.hull.vertices.end(), 0u);
}

}  // namespace

Patch make_patch(const NormalMesh& mesh, const Plates& plates,
                 std::span<const std::uint32_t> members, const GrowingHull* hull, bool back_open) {
  Patch patch;
  patch.back_open = back_open;
  for (const std::uint32_t plate : members) {
    const auto faces = plates.faces_of(plate);
    patch.faces.insert(patch.faces.end(), faces.begin(), faces.end());
  }
  std::sort(patch.faces.begin(), patch.faces.end());

  if (hull == nullptr) {
    patch.hull = canonical_flat_hull(plates.corners_of(members.front()));
  } else {
    FacetHull solid = canonical_hull(mesh.points, hull->triangles());
    Coverage coverage(mesh, solid);
    for (const std::uint32_t plate : members) coverage.add(plates.corners_of(plate));
    for (std::size_t f = 0; f < solid.mesh.faces.size(); ++f)
      if (!coverage.covers(f)) patch.virtual_faces.push_back(solid.mesh.faces[f]);
    patch.hull = std::move(solid.mesh);
  }
  patch.all_real = patch.virtual_faces.empty();
  list_vertices(mesh, patch);
  return patch;
}

}  // namespace palpate::bake
