// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Min_sphere_of_points_d_traits_3.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>

#include "host_bake/base/error.hpp"
#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {
namespace {

struct Extent {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Point high{-low[0], -low[0], -low[0]};
};

std::string text(const Point& p) {
  std::ostringstream out;
  out << '(' << p[0] << ", " << p[1] << ", " << p[2] << ')';
  return out.str();
}

Extent box_of(const Mesh& mesh) {
  Extent box;
  for (const Face& face : mesh.faces)
    for (const std::uint32_t v : face)
      for (std::size_t i = 0; i < 3; ++i) {
        const double x = mesh.points[v][i];
        if (!std::isfinite(x))
          throw InputRefused("coordinate is not finite", "vertex " + std::to_string(v),
                             "remove the faces at this vertex");
        box.low[i] = std::min(box.low[i], x);
        box.high[i] = std::max(box.high[i], x);
      }
  return box;
}

/// The smallest sphere about the points, by CGAL's exact algorithm in double arithmetic (Fischer
/// and Gartner 2003); its rounding is taken up by radius_about().
Point centre_of(const std::vector<Point>& points) {
  using Plain = CGAL::Simple_cartesian<double>;
  using Traits = CGAL::Min_sphere_of_points_d_traits_3<Plain, double>;
  std::vector<Plain::Point_3> spheres;
  spheres.reserve(points.size());
  for (const Point& p : points) spheres.emplace_back(p[0], p[1], p[2]);
  CGAL::Min_sphere_of_spheres_d<Traits> smallest(spheres.begin(), spheres.end());
  const auto* x = smallest.center_cartesian_begin();
  return {x[0], x[1], x[2]};
}

double radius_about(const Point& centre, const std::vector<Point>& points) {
  double squared = 0;
  for (const Point& p : points) {
    const double x = p[0] - centre[0];
    const double y = p[1] - centre[1];
    const double z = p[2] - centre[2];
    squared = std::max(squared, x * x + y * y + z * z);
  }
  return std::sqrt(squared);
}

/// The mesh about the centre of its box at size 1: no scale or offset of the input can overflow or
/// cancel in what follows.
struct Scaled {
  std::vector<char> used;     ///< of each vertex: a face refers to it
  std::vector<Point> points;  ///< of each vertex
  Point centre{};             ///< of the smallest sphere about those used
  double radius = 0;
};

double longest_side(const Extent& box) {
  return std::max({box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
}

Point middle_of(const Extent& box) {
  return {box.low[0] / 2 + box.high[0] / 2, box.low[1] / 2 + box.high[1] / 2,
          box.low[2] / 2 + box.high[2] / 2};
}

/// Precondition: a box of normal size.
Scaled scaled_into(const Extent& box, const Mesh& mesh) {
  const Point middle = middle_of(box);
  const double size = longest_side(box);
  Scaled scaled;
  scaled.used.resize(mesh.points.size(), 0);
  for (const Face& face : mesh.faces)
    for (const std::uint32_t v : face) scaled.used[v] = 1;
  scaled.points.resize(mesh.points.size(), Point{});
  std::vector<Point> referenced;
  for (std::size_t v = 0; v < scaled.points.size(); ++v) {
    if (!scaled.used[v]) continue;
    for (std::size_t i = 0; i < 3; ++i)
      scaled.points[v][i] = (mesh.points[v][i] - middle[i]) / size;
    referenced.push_back(scaled.points[v]);
  }
  scaled.centre = centre_of(referenced);
  scaled.radius = radius_about(scaled.centre, referenced);
  return scaled;
}

}  // namespace

double radius_of(const Mesh& mesh) {
  const Extent box = box_of(mesh);
  const double size = longest_side(box);
  return std::isnormal(size) ? size * scaled_into(box, mesh).radius : 0;
}

NormalMesh normalise(const Mesh& mesh) {
  if (mesh.faces.empty())
    throw InputRefused("mesh is empty", "no faces", "give a mesh with triangles");
  const Extent box = box_of(mesh);
  const double size = longest_side(box);
  if (!std::isnormal(size))
    throw InputRefused("mesh has no measurable size",
                       "from " + text(box.low) + " to " + text(box.high),
                       "give a mesh of finite extent in metres, or set the unit scale");

  const Scaled scaled = scaled_into(box, mesh);
  NormalMesh normal;
  normal.faces = mesh.faces;
  normal.points.resize(mesh.points.size(), {0, 0, 0});
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (!scaled.used[v]) continue;
    for (std::size_t i = 0; i < 3; ++i)
      normal.points[v][i] =
          static_cast<float>((scaled.points[v][i] - scaled.centre[i]) / scaled.radius);
  }
  const Point middle = middle_of(box);
  for (std::size_t i = 0; i < 3; ++i) normal.centre_m[i] = middle[i] + size * scaled.centre[i];
  normal.radius_m = size * scaled.radius;
  return normal;
}

}  // namespace palpate::bake
