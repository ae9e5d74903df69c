// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace palpate::bake {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vector = Kernel::Vector_3;
using Plane = CGAL::Projection_traits_3<Kernel>;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Plane>;
using InsideBase = CGAL::Triangulation_face_base_with_info_2<bool, Plane>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Plane, InsideBase>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Plane, Structure,
                                                            CGAL::No_constraint_intersection_tag>;

using Polygon = std::span<const std::uint32_t>;
using Side = std::pair<std::uint32_t, std::uint32_t>;

Vector difference(const Point& to, const Point& from) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

/// Newell's normal, relative to the first corner against cancellation.
Vector newell_normal(const std::vector<Point>& points, Polygon polygon) {
  Vector normal(0, 0, 0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += CGAL::cross_product(difference(points[polygon[i]], points[polygon[0]]),
                                  difference(points[polygon[i + 1]], points[polygon[0]]));
  }
  return normal;
}

void fan(Polygon polygon, std::vector<Face>& faces) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    faces.push_back({polygon[0], polygon[i], polygon[i + 1]});
  }
}

/// How well the normals of the two triangles agree when a quad is cut from corner a to corner c.
double agreement(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Vector diagonal = difference(c, a);
  return CGAL::to_double(CGAL::cross_product(difference(b, a), diagonal) *
                         CGAL::cross_product(diagonal, difference(d, a)));
}

void split_quad(const std::vector<Point>& points, Polygon q, std::vector<Face>& faces) {
  const Point &a = points[q[0]], &b = points[q[1]], &c = points[q[2]], &d = points[q[3]];
  const double from_first = agreement(a, b, c, d);
  if (from_first > 0 || from_first >= agreement(b, c, d, a)) {
    faces.insert(faces.end(), {Face{q[0], q[1], q[2]}, Face{q[0], q[2], q[3]}});
  } else {
    faces.insert(faces.end(), {Face{q[1], q[2], q[3]}, Face{q[1], q[3], q[0]}});
  }
}

/// The sides of the polygon that part inside from outside. A bridge to a hole is walked both ways
/// and parts nothing.
std::set<Side> parting_sides(Polygon polygon) {
  std::set<Side> sides;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Side side = std::minmax(polygon[i], polygon[(i + 1) % polygon.size()]);
    if (side.first == side.second) continue;
    if (!sides.insert(side).second) sides.erase(side);
  }
  return sides;
}

/// False where two vertices share a place in the plane or two sides cross.
bool insert(Delaunay& plane, const std::vector<Point>& points, Polygon polygon) {
  std::map<std::uint32_t, Delaunay::Vertex_handle> handles;
  for (const std::uint32_t corner : polygon) {
    if (handles.count(corner) > 0) continue;
    const Point& p = points[corner];
    const Delaunay::Vertex_handle handle = plane.insert(Kernel::Point_3(p[0], p[1], p[2]));
    handle->info() = corner;
    handles.emplace(corner, handle);
  }
  if (plane.dimension() != 2 || plane.number_of_vertices() != handles.size()) return false;
  try {
    for (const auto& [a, b] : parting_sides(polygon))
      plane.insert_constraint(handles[a], handles[b]);
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return false;
  }
  return true;
}

/// Sets info() of each triangle to whether it lies inside, walking in from infinity.
void mark_inside(Delaunay& plane) {
  std::vector<Delaunay::Face_handle> open{plane.infinite_face()};
  std::set<Delaunay::Face_handle> reached{open.front()};
  open.front()->info() = false;
  while (!open.empty()) {
    const Delaunay::Face_handle face = open.back();
    open.pop_back();
    for (int i = 0; i < 3; ++i) {
      const Delaunay::Face_handle next = face->neighbor(i);
      if (!reached.insert(next).second) continue;
      next->info() = face->info() != face->is_constrained(i);
      open.push_back(next);
    }
  }
}

/// False where the polygon crosses itself in its plane.
bool split_in_plane(const std::vector<Point>& points, Polygon polygon, const Vector& normal,
                    std::vector<Face>& faces) {
  Delaunay plane{Plane(normal)};
  if (!insert(plane, points, polygon)) return false;
  mark_inside(plane);
  const std::size_t before = faces.size();
  for (const auto face : plane.finite_face_handles()) {
    if (!face->info()) continue;
    // The plane is seen along the normal, so its counter-clockwise is the polygon's.
    faces.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  // So many there are where the polygon is simple, or leads to a hole and back along a bridge.
  if (faces.size() - before == polygon.size() - 2) return true;
  faces.resize(before);
  return false;
}

}  // namespace

void triangulate(const std::vector<Point>& points, Polygon polygon, std::vector<Face>& faces) {
  if (polygon.size() == 3) return fan(polygon, faces);
  if (polygon.size() == 4) return split_quad(points, polygon, faces);
  const Vector normal = newell_normal(points, polygon);
  if (normal == Vector(0, 0, 0) || !split_in_plane(points, polygon, normal, faces)) {
    fan(polygon, faces);
  }
}

}  // namespace palpate::bake
