// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hull/quickhull.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <cstddef>

namespace palpate::bake {

std::vector<Triangle> quickhull(std::span<const PointF> points,
                                std::span<const std::uint32_t> ids) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> input;
  input.reserve(ids.size());
  for (const std::uint32_t id : ids)
    input.emplace_back(static_cast<double>(points[id][0]), static_cast<double>(points[id][1]),
                       static_cast<double>(points[id][2]));
  std::vector<Kernel::Point_3> corners;
  std::vector<std::array<std::size_t, 3>> faces;
  CGAL::convex_hull_3(input.begin(), input.end(), corners, faces);

  std::vector<std::uint32_t> id_of;
  id_of.reserve(corners.size());
  for (const Kernel::Point_3& corner : corners) {
    const auto found = std::lower_bound(input.begin(), input.end(), corner);
    id_of.push_back(ids[static_cast<std::size_t>(found - input.begin())]);
  }
  std::vector<Triangle> triangles;
  triangles.reserve(faces.size());
  for (const auto& face : faces)
    triangles.push_back({id_of[face[0]], id_of[face[1]], id_of[face[2]]});
  return triangles;
}

}  // namespace palpate::bake
