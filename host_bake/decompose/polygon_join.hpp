// SPDX-License-Identifier: GPL-3.0-or-later
// Joins the triangles of a plane region to convex polygons.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/decompose/surface_edges.hpp"
#include "host_bake/hull/predicates.hpp"
#include "host_bake/mesh/topology.hpp"

namespace palpate::bake {

/// Joins two neighbouring convex polygons where the union is convex, longest edge first, until no
/// pair is left (Hertel and Mehlhorn 1983). `faces` are connected by flat edges and have area;
/// `group` is of all faces of the mesh and receives the joins. No group becomes larger than
/// most_faces. Exact predicates; each sweep over the edges that are left is linear, and sweeps end
/// when one joins nothing.
class PolygonJoin {
 public:
  PolygonJoin(const NormalMesh& mesh, const SurfaceEdges& edges);
  void run(std::span<const std::uint32_t> faces, std::uint32_t most_faces, Sets& group);

 private:
  struct Chain {
    std::uint32_t first,
        last;  // half-edges of one polygon along the common border, in its direction
  };
  [[nodiscard]] bool twins(std::uint32_t h, std::uint32_t t) const;
  [[nodiscard]] Chain common_border(std::uint32_t h) const;
  [[nodiscard]] bool straight_or_left(std::uint32_t into, std::uint32_t out) const;
  bool join(std::uint32_t h, std::uint32_t most_faces, Sets& group);

  const NormalMesh& mesh_;
  const SurfaceEdges& edges_;
  Projection view_{};
  std::vector<std::uint32_t> next_, previous_;  // around each polygon
  std::vector<std::uint32_t> size_;             // faces of each group, at its name
};

}  // namespace palpate::bake
