// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hull/quickhull.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace palpate::bake {

std::vector<Triangle> quickhull(std::span<const PointF> points,
                                std::span<const std::uint32_t> ids) {
  assert(ids.size() > 4);
  // Planes have to be exact too: with rounded ones CGAL 5.5.1 gives hulls that are not closed.
  using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
  std::vector<Kernel::Point_3> input;
  input.reserve(ids.size());
  for (const std::uint32_t id : ids)
    input.emplace_back(static_cast<double>(points[id][0]), static_cast<double>(points[id][1]),
                       static_cast<double>(points[id][2]));
  // Into a mesh, not into ranges of points and triangles: for those CGAL 5.5.1 takes the kernel
  // itself as traits, whose planes are rounded, and gives hulls that are not quite convex.
  using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
  Surface surface;
  CGAL::convex_hull_3(input.begin(), input.end(), surface);

  std::vector<std::uint32_t> id_of;
  id_of.reserve(surface.number_of_vertices());
  for (const Surface::Vertex_index v : surface.vertices()) {
    const auto found = std::lower_bound(input.begin(), input.end(), surface.point(v));
    id_of.push_back(ids[static_cast<std::size_t>(found - input.begin())]);
  }
  std::vector<Triangle> triangles;
  triangles.reserve(surface.number_of_faces());
  for (const Surface::Face_index f : surface.faces()) {
    Triangle triangle{};
    std::size_t corner = 0;
    for (const Surface::Vertex_index v : surface.vertices_around_face(surface.halfedge(f)))
      triangle[corner++] = id_of[v];
    triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace palpate::bake
