// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/plates.hpp"

#include <algorithm>
#include <limits>

#include "host_bake/decompose/flat_cover.hpp"
#include "host_bake/decompose/polygon_join.hpp"
#include "host_bake/hull/facets.hpp"
#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class PlateMaker {
 public:
  PlateMaker(const NormalMesh& mesh, const SurfaceEdges& edges, const std::vector<char>& crossing,
             const std::vector<std::uint32_t>& most_faces)
      : mesh_(mesh),
        crossing_(crossing),
        most_faces_(most_faces),
        inner_(edges),
        group_(mesh.faces.size()) {
    // A crossing face shares its plane with nobody.
    for (std::size_t h = 0; h < inner_.kind.size(); ++h)
      if (inner_.kind[h] == EdgeKind::flat && (crossing_[h / 3] || crossing_[inner_.twin[h] / 3]))
        inner_.kind[h] = EdgeKind::convex;
  }

  Plates run() {
    join_regions();
    adopt_faces_without_area();
    return number();
  }

 private:
  void join_regions() {
    PolygonJoin join(mesh_, inner_);
    std::vector<std::uint32_t> region_of(mesh_.faces.size(), kNone);
    std::vector<std::uint32_t> region;
    for (std::uint32_t seed = 0; seed < mesh_.faces.size(); ++seed) {
      if (region_of[seed] != kNone) continue;
      flood(seed, region_of, region);
      if (region.size() == 1) continue;
      if (region.size() <= most_faces_[seed] &&
          fills_convex_polygon(mesh_, inner_, region, region_of, seed)) {
        for (const std::uint32_t f : region) group_.join(seed, f);
      } else {
        join.run(region, most_faces_[seed], group_);
      }
    }
  }

  void flood(std::uint32_t seed, std::vector<std::uint32_t>& region_of,
             std::vector<std::uint32_t>& out_region) const {
    out_region.assign(1, seed);
    region_of[seed] = seed;
    for (std::size_t head = 0; head < out_region.size(); ++head)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t h = 3 * std::size_t{out_region[head]} + k;
        if (inner_.kind[h] != EdgeKind::flat) continue;
        const std::uint32_t g = inner_.twin[h] / 3;
        if (region_of[g] != kNone) continue;
        region_of[g] = seed;
        out_region.push_back(g);
      }
  }

  /// A face without area lies on its longest side; the plate across that side contains it. Chains
  /// of such faces are taken in from the end that touches a plate.
  void adopt_faces_without_area() {
    std::vector<std::uint32_t> size(mesh_.faces.size(), 0);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      ++size[group_.find(f)];
      if (!inner_.degenerate[f] && !crossing_[f]) queue.push_back(f);
    }
    std::vector<char> adopted(mesh_.faces.size(), 0);
    for (std::size_t head = 0; head < queue.size(); ++head)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t h = 3 * std::size_t{queue[head]} + k;
        if (inner_.twin[h] == SurfaceEdges::kNone) continue;
        const std::uint32_t g = inner_.twin[h] / 3;
        const std::uint32_t group = group_.find(queue[head]);
        if (!inner_.degenerate[g] || crossing_[g] || adopted[g] || size[group] >= most_faces_[g] ||
            !lies_on(inner_.twin[h]))
          continue;
        adopted[g] = 1;
        const std::uint32_t total = size[group] + 1;
        group_.join(group, g);
        size[group_.find(g)] = total;
        queue.push_back(g);
      }
  }

  /// The face's third corner, in line with the half-edge, is not beyond its ends.
  [[nodiscard]] bool lies_on(std::size_t half_edge) const {
    const PointF& a = mesh_.points[edge_start(mesh_, half_edge)];
    const PointF& b = mesh_.points[edge_end(mesh_, half_edge)];
    const PointF& c = mesh_.points[edge_apex(mesh_, half_edge)];
    return std::min(a, b) <= c && c <= std::max(a, b);
  }

  Plates number() {
    Plates plates;
    plates.of_face.assign(mesh_.faces.size(), kNone);
    std::vector<std::uint32_t> plate_of_group(mesh_.faces.size(), kNone);
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      std::uint32_t& plate = plate_of_group[group_.find(f)];
      if (plate == kNone) {
        plate = static_cast<std::uint32_t>(plates.fixed.size());
        plates.fixed.push_back(crossing_[f]);
      }
      plates.of_face[f] = plate;
    }
    plates.first_face.assign(plates.size() + 1, 0);
    for (const std::uint32_t plate : plates.of_face) ++plates.first_face[plate + 1];
    for (std::size_t p = 0; p < plates.size(); ++p)
      plates.first_face[p + 1] += plates.first_face[p];
    plates.faces.resize(mesh_.faces.size());
    std::vector<std::uint32_t> at(plates.first_face.begin(), plates.first_face.end() - 1);
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
      plates.faces[at[plates.of_face[f]]++] = f;

    plates.first_corner.push_back(0);
    for (std::uint32_t p = 0; p < plates.size(); ++p) append_corners(p, plates);
    return plates;
  }

  void append_corners(std::uint32_t plate, Plates& plates) const {
    const std::span<const std::uint32_t> faces = plates.faces_of(plate);
    const auto spans_plane = std::find_if(faces.begin(), faces.end(),
                                          [&](std::uint32_t f) { return !inner_.degenerate[f]; });
    const bool flat = spans_plane != faces.end();
    const Face& face = mesh_.faces[flat ? *spans_plane : faces.front()];
    std::vector<std::uint32_t> corners(face.begin(), face.end());
    if (faces.size() > 1 || !flat) {
      corners.clear();
      for (const std::uint32_t f : faces)
        corners.insert(corners.end(), mesh_.faces[f].begin(), mesh_.faces[f].end());
      const Projection view =
          projection_of(mesh_.points[face[0]], mesh_.points[face[1]], mesh_.points[face[2]]);
      corners = flat_ring(mesh_.points, corners, view);
    }
    if (!flat) plates.fixed[plate] = 1;
    plates.corners.insert(plates.corners.end(), corners.begin(), corners.end());
    plates.first_corner.push_back(static_cast<std::uint32_t>(plates.corners.size()));
  }

  const NormalMesh& mesh_;
  const std::vector<char>& crossing_;
  const std::vector<std::uint32_t>& most_faces_;
  SurfaceEdges inner_;
  Sets group_;
};

}  // namespace

Plates make_plates(const NormalMesh& mesh, const SurfaceEdges& edges,
                   const std::vector<char>& crossing,
                   const std::vector<std::uint32_t>& most_faces) {
  return PlateMaker(mesh, edges, crossing, most_faces).run();
}

}  // namespace palpate::bake
