// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/level_record.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "host_bake/decompose/patch_hull.hpp"
#include "host_bake/hull/growing_hull.hpp"
#include "host_bake/hull/predicates.hpp"

namespace palpate::bake {
namespace {

std::uint32_t follow(std::vector<std::uint32_t>& heir, std::uint32_t x) {
  for (; heir[x] != x; x = heir[x]) heir[x] = heir[heir[x]];
  return x;
}

/// Every face is a plate of its own, but the faces of a flat patch are one.
class PatchMaker {
 public:
  explicit PatchMaker(const NormalMesh& mesh) : mesh_(mesh), hull_(mesh.points) {}

  /// faces: ascending.
  Patch make(const std::vector<std::uint32_t>& faces, const Surface& surface,
             const std::vector<std::uint32_t>& face_in_surface,
             const std::vector<std::uint32_t>& place_of_face, bool back_open) {
    const bool solid = faces.size() > 1 && grow(faces, surface, face_in_surface, place_of_face);
    Plates plates;
    plates.first_face.push_back(0);
    plates.first_corner.push_back(0);
    if (solid) {
      for (const std::uint32_t f : faces)
        add(plates, {f}, {mesh_.faces[f].begin(), mesh_.faces[f].end()});
    } else {
      add(plates, faces, outline(faces));
    }
    std::vector<std::uint32_t> members(plates.first_face.size() - 1);
    std::iota(members.begin(), members.end(), 0u);
    return make_patch(mesh_, plates, members, solid ? &hull_ : nullptr, back_open);
  }

 private:
  static void add(Plates& plates, const std::vector<std::uint32_t>& faces,
                  const std::vector<std::uint32_t>& corners) {
    plates.faces.insert(plates.faces.end(), faces.begin(), faces.end());
    plates.first_face.push_back(static_cast<std::uint32_t>(plates.faces.size()));
    plates.corners.insert(plates.corners.end(), corners.begin(), corners.end());
    plates.first_corner.push_back(static_cast<std::uint32_t>(plates.corners.size()));
  }

  [[nodiscard]] std::vector<std::uint32_t> outline(const std::vector<std::uint32_t>& faces) const {
    std::vector<std::uint32_t> corners;
    Projection view;
    for (const std::uint32_t f : faces) {
      const Face& t = mesh_.faces[f];
      corners.insert(corners.end(), t.begin(), t.end());
      if (view.facing == 0)
        view = projection_of(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]);
    }
    return flat_ring(mesh_.points, corners, view);
  }

  /// Breadth-first, so that each vertex is added next to one that is there. False where flat.
  bool grow(const std::vector<std::uint32_t>& faces, const Surface& surface,
            const std::vector<std::uint32_t>& face_in_surface,
            const std::vector<std::uint32_t>& place_of_face) {
    const auto seed = std::find_if(faces.begin(), faces.end(), [&](std::uint32_t f) {
      const Face& t = mesh_.faces[f];
      return !collinear(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]);
    });
    if (seed == faces.end()) return false;
    hull_.start(mesh_.faces[*seed], false);
    std::vector<std::uint32_t> order = {*seed};
    std::vector<char> seen(faces.size(), 0);
    seen[static_cast<std::size_t>(seed - faces.begin())] = 1;
    std::size_t seed_after = 0;  // patches that hang together at a vertex only need more seeds
    for (std::size_t next = 0; order.size() < faces.size() || next < order.size(); ++next) {
      if (next == order.size()) {
        while (seen[seed_after] != 0) ++seed_after;
        seen[seed_after] = 1;
        order.push_back(faces[seed_after]);
      }
      const std::uint32_t f = face_in_surface[order[next]];
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        if (surface.twin[h] == kNothing) continue;
        const std::uint32_t g = place_of_face[surface.twin[h] / 3];
        const auto found = std::lower_bound(faces.begin(), faces.end(), g);
        if (found == faces.end() || *found != g) continue;
        char& s = seen[static_cast<std::size_t>(found - faces.begin())];
        if (s == 0) order.push_back(g);
        s = 1;
      }
    }
    for (int round = 0; round < 2; ++round)
      for (const std::uint32_t f : order) insert_corners(mesh_.faces[f]);
    return !hull_.flat();
  }

  void insert_corners(const Face& face) {
    for (const std::uint32_t v : face) {
      if (hull_.has(v)) continue;
      std::uint32_t near = GrowingHull::kNone;
      for (const std::uint32_t other : face)
        if (hull_.has(other)) near = other;
      static_cast<void>(hull_.insert(v, near));  // nothing is real, so nothing is refused
    }
  }

  const NormalMesh& mesh_;
  GrowingHull hull_;
};

}  // namespace

LevelRecord::LevelRecord(const NormalMesh& original, std::uint32_t patches)
    : original_(original),
      vertex_heir_(original.points.size()),
      face_heir_(original.faces.size()),
      vertices_(original.points.size()),
      faces_(original.faces.size()),
      patches_(patches) {
  for (auto* ids : {&vertex_heir_, &face_heir_, &vertices_, &faces_, &patches_})
    std::iota(ids->begin(), ids->end(), 0u);
}

SimplifiedLevel LevelRecord::take(const Surface& surface, const PatchLists& patches,
                                  double resolution) {
  SimplifiedLevel level;
  level.resolution = resolution;
  level.mesh.centre_m = original_.centre_m;
  level.mesh.radius_m = original_.radius_m;

  std::vector<std::uint32_t> place_of_vertex(surface.points.size(), kNothing);
  std::vector<std::uint32_t> place_of_face(surface.faces.size(), kNothing);
  std::vector<std::uint32_t> vertices, faces;
  std::vector<std::vector<std::uint32_t>> faces_of_patch(patches.count());
  for (const std::uint32_t v : vertices_) {
    // Original vertices without faces stay as they are, so that every vertex has a heir.
    if (vertex_heir_[v] != v) continue;
    place_of_vertex[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(v);
    level.mesh.points.push_back(surface.points[v]);
  }
  for (const std::uint32_t f : faces_) {
    if (!surface.alive(f)) continue;
    const Face& t = surface.faces[f];
    place_of_face[f] = static_cast<std::uint32_t>(faces.size());
    faces_of_patch[patches.of(f)].push_back(place_of_face[f]);
    faces.push_back(f);
    level.mesh.faces.push_back(
        {place_of_vertex[t[0]], place_of_vertex[t[1]], place_of_vertex[t[2]]});
  }

  std::vector<std::uint32_t> place_of_patch(patches.count(), kNothing), alive;
  PatchMaker maker(level.mesh);
  for (std::uint32_t p = 0; p < patches.count(); ++p) {
    if (!patches.alive(p)) continue;
    place_of_patch[p] = static_cast<std::uint32_t>(alive.size());
    alive.push_back(p);
    level.patches.push_back(
        maker.make(faces_of_patch[p], surface, faces, place_of_face, patches.back_open(p)));
  }

  for (const std::uint32_t v : vertices_)
    level.vertex_of_vertex.push_back(place_of_vertex[follow(vertex_heir_, v)]);
  for (const std::uint32_t f : faces_)
    level.face_of_face.push_back(place_of_face[follow(face_heir_, f)]);
  for (const std::uint32_t p : patches_)
    level.parent_of_patch.push_back(place_of_patch[patches.heir(p)]);
  vertices_ = std::move(vertices);
  faces_ = std::move(faces);
  patches_ = std::move(alive);
  return level;
}

}  // namespace palpate::bake
