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

}  // namespace

NormalMesh normalise(const Mesh& mesh) {
  if (mesh.faces.empty())
    throw InputRefused("mesh is empty", "no faces", "give a mesh with triangles");
  const Extent box = box_of(mesh);
  const Point middle = {box.low[0] / 2 + box.high[0] / 2, box.low[1] / 2 + box.high[1] / 2,
                        box.low[2] / 2 + box.high[2] / 2};
  const double size =
      std::max({box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
  if (!std::isnormal(size))
    throw InputRefused("mesh has no measurable size",
                       "from " + text(box.low) + " to " + text(box.high),
                       "give a mesh of finite extent in metres, or set the unit scale");

  // Everything below happens about the box centre at size 1: no scale or offset of the input can
  // overflow or cancel in it.
  std::vector<char> used(mesh.points.size(), 0);
  for (const Face& face : mesh.faces)
    for (const std::uint32_t v : face) used[v] = 1;
  std::vector<Point> scaled(mesh.points.size(), Point{});
  std::vector<Point> referenced;
  for (std::size_t v = 0; v < scaled.size(); ++v) {
    if (!used[v]) continue;
    for (std::size_t i = 0; i < 3; ++i) scaled[v][i] = (mesh.points[v][i] - middle[i]) / size;
    referenced.push_back(scaled[v]);
  }
  const Point centre = centre_of(referenced);
  const double radius = radius_about(centre, referenced);

  NormalMesh normal;
  normal.faces = mesh.faces;
  normal.points.resize(scaled.size(), {0, 0, 0});
  for (std::size_t v = 0; v < scaled.size(); ++v) {
    if (!used[v]) continue;
    for (std::size_t i = 0; i < 3; ++i)
      normal.points[v][i] = static_cast<float>((scaled[v][i] - centre[i]) / radius);
  }
  for (std::size_t i = 0; i < 3; ++i) normal.centre_m[i] = middle[i] + size * centre[i];
  normal.radius_m = size * radius;
  return normal;
}

}  // namespace palpate::bake
