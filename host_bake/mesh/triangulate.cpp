// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>

namespace palpate::bake {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vector = Kernel::Vector_3;
using Plane = CGAL::Projection_traits_3<Kernel>;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Plane>;
using OutsideBase = CGAL::Triangulation_face_base_with_info_2<bool, Plane>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Plane, OutsideBase>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Plane, Structure,
                                                            CGAL::No_constraint_intersection_tag>;

using Polygon = std::span<const std::uint32_t>;

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
  if (agreement(a, b, c, d) >= agreement(b, c, d, a)) {
    faces.insert(faces.end(), {Face{q[0], q[1], q[2]}, Face{q[0], q[2], q[3]}});
  } else {
    faces.insert(faces.end(), {Face{q[1], q[2], q[3]}, Face{q[1], q[3], q[0]}});
  }
}

/// Marks the triangles that can be reached from infinity without crossing the polygon.
void mark_outside(Delaunay& plane) {
  for (const auto face : plane.all_face_handles()) face->info() = false;
  std::vector<Delaunay::Face_handle> open{plane.infinite_face()};
  while (!open.empty()) {
    const Delaunay::Face_handle face = open.back();
    open.pop_back();
    if (face->info()) continue;
    face->info() = true;
    for (int i = 0; i < 3; ++i) {
      if (!face->is_constrained(i)) open.push_back(face->neighbor(i));
    }
  }
}

/// False where the polygon crosses itself in its plane.
bool split_in_plane(const std::vector<Point>& points, Polygon polygon, const Vector& normal,
                    std::vector<Face>& faces) {
  Delaunay plane{Plane(normal)};
  std::vector<Delaunay::Vertex_handle> handles;
  for (const std::uint32_t corner : polygon) {
    const Point& p = points[corner];
    const std::size_t before = plane.number_of_vertices();
    handles.push_back(plane.insert(Kernel::Point_3(p[0], p[1], p[2])));
    if (plane.number_of_vertices() > before) handles.back()->info() = corner;
    if (handles.back()->info() != corner) return false;
  }
  if (plane.dimension() != 2) return false;
  try {
    for (std::size_t i = 0; i < handles.size(); ++i) {
      plane.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
    }
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return false;
  }
  mark_outside(plane);
  const std::size_t before = faces.size();
  for (const auto face : plane.finite_face_handles()) {
    if (face->info()) continue;
    // The plane is seen along the normal, so its counter-clockwise is the polygon's.
    faces.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  // So many there are where the polygon is simple, or leads to a hole and back along one bridge
  // edge.
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
