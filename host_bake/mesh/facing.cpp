// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/mesh/facing.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "host_bake/mesh/cgal_point.hpp"

namespace palpate::bake {
namespace {

using Kernel = CgalKernel;
using Point3 = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr double kNearlyClosed = 0.1;  ///< vector area over area
/// Volume over that of the sphere with the same area, below which a sign says nothing: rounding for
/// closed components, a sheet's small bulge for open ones. The bunny has 0.4.
constexpr double kLeastClosedFullness = 1e-9;
constexpr double kLeastOpenFullness = 0.01;

/// Sums over one component.
struct Shape {
  double area = 0;
  Vector vector_area{0, 0, 0};
  Vector weighted_centre{0, 0, 0};  ///< times area, relative to the origin of shapes_of()
  double volume = 0;                ///< of the cone from the centroid

  [[nodiscard]] double fullness() const {
    return volume * 6 * std::sqrt(std::numbers::pi) / (area * std::sqrt(area));
  }
};

/// Coordinates are divided by the extent of the mesh first, so that no cube of a length underflows.
std::vector<Shape> shapes_of(const Mesh& mesh, const Components& components) {
  std::vector<Shape> shapes(components.closed.size());
  CGAL::Bbox_3 box;
  for (const Point& p : mesh.points) box += to_cgal(p).bbox();
  const double extent = std::max({box.x_span(), box.y_span(), box.z_span()});
  const auto local = [&box, extent](const Point& p) {
    return Vector((p[0] - box.xmin()) / extent, (p[1] - box.ymin()) / extent,
                  (p[2] - box.zmin()) / extent);
  };
  const auto for_each_face = [&](auto visit) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      if (components.of_face[f] == kNoComponent) continue;
      const Face& v = mesh.faces[f];
      visit(shapes[components.of_face[f]], local(mesh.points[v[0]]), local(mesh.points[v[1]]),
            local(mesh.points[v[2]]));
    }
  };
  for_each_face([](Shape& shape, const Vector& a, const Vector& b, const Vector& c) {
    const Vector normal = CGAL::cross_product(b - a, c - a) / 2;
    const double area = std::sqrt(normal.squared_length());
    shape.area += area;
    shape.vector_area += normal;
    shape.weighted_centre += area / 3 * (a + b + c);
  });
  for_each_face([](Shape& shape, const Vector& a, const Vector& b, const Vector& c) {
    if (shape.area <= 0) return;
    const Vector centre = shape.weighted_centre / shape.area;
    shape.volume += CGAL::determinant(a - centre, b - centre, c - centre) / 6;
  });
  return shapes;
}

/// +1 where the face is above the point and looks up, -1 where it is above and looks down, else 0.
int crossing_above(const Kernel::Triangle_3& t, const Point3& p) {
  int turns = 0;  // of the projected triangle around the projected point
  for (int i = 0; i < 3; ++i) {
    const Point3 &u = t.vertex(i), &v = t.vertex(i + 1);
    const bool from_below = u.y() <= p.y(), to_below = v.y() <= p.y();
    if (from_below == to_below) continue;
    const auto side =
        CGAL::orientation(Kernel::Point_2(u.x(), u.y()), Kernel::Point_2(v.x(), v.y()),
                          Kernel::Point_2(p.x(), p.y()));
    if (from_below && side == CGAL::LEFT_TURN) ++turns;
    if (to_below && side == CGAL::RIGHT_TURN) --turns;
  }
  const auto side = CGAL::orientation(t.vertex(0), t.vertex(1), t.vertex(2), p);
  if (turns > 0) return side == CGAL::NEGATIVE ? 1 : 0;
  return turns < 0 && side == CGAL::POSITIVE ? -1 : 0;
}

/// Which closed components lie in which.
class Nesting {
 public:
  Nesting(const Mesh& mesh, const Components& components) : in_(components.closed.size()) {
    std::vector<Point3> first(components.closed.size());
    std::vector<char> seen(components.closed.size(), 0);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const std::uint32_t component = components.of_face[f];
      if (component == kNoComponent || !components.closed[component]) continue;
      const Face& v = mesh.faces[f];
      const Kernel::Triangle_3 triangle(to_cgal(mesh.points[v[0]]), to_cgal(mesh.points[v[1]]),
                                        to_cgal(mesh.points[v[2]]));
      if (!seen[component]) first[component] = triangle.vertex(0);
      seen[component] = 1;
      // A face seen edge-on by a vertical ray is never crossed, so those without area may stay out.
      if (triangle.is_degenerate()) continue;
      triangles_.push_back(triangle);
      owner_.push_back(component);
    }
    tree_.rebuild(triangles_.cbegin(), triangles_.cend());
    for (std::uint32_t c = 0; c < in_.size(); ++c) {
      if (components.closed[c]) in_[c] = containers(first[c], c);
    }
  }

  [[nodiscard]] std::size_t depth(std::uint32_t component) const { return in_[component].size(); }

  /// The innermost component around this one. Precondition: depth() above 0.
  [[nodiscard]] std::uint32_t parent(std::uint32_t component) const {
    return *std::max_element(
        in_[component].begin(), in_[component].end(),
        [this](std::uint32_t a, std::uint32_t b) { return depth(a) < depth(b); });
  }

 private:
  std::vector<std::uint32_t> containers(const Point3& p, std::uint32_t self) const {
    std::vector<Primitive::Id> above;
    tree_.all_intersected_primitives(Kernel::Ray_3(p, Vector(0, 0, 1)), std::back_inserter(above));
    std::map<std::uint32_t, int> winding;
    for (const Primitive::Id id : above) {
      const std::uint32_t owner = owner_[static_cast<std::size_t>(id - triangles_.cbegin())];
      if (owner != self) winding[owner] += crossing_above(*id, p);
    }
    std::vector<std::uint32_t> around;
    for (const auto& [component, turns] : winding) {
      if (turns != 0) around.push_back(component);
    }
    return around;
  }

  Triangles triangles_;
  std::vector<std::uint32_t> owner_;
  Tree tree_;
  std::vector<std::vector<std::uint32_t>> in_;
};

Facing facing_of_open(const Shape& shape) {
  if (!(shape.area > 0) || shape.fullness() > -kLeastOpenFullness) return Facing::fine;
  const double openness = std::sqrt(shape.vector_area.squared_length()) / shape.area;
  return openness < kNearlyClosed ? Facing::inward : Facing::doubtful;
}

void face_closed(const Mesh& mesh, const Components& components, const std::vector<bool>& negative,
                 std::vector<Facing>& facing) {
  const Nesting nesting(mesh, components);
  std::vector<std::uint32_t> order;
  for (std::uint32_t c = 0; c < facing.size(); ++c) {
    if (components.closed[c]) order.push_back(c);
  }
  // Outermost first: what is inside inherits the turn.
  std::stable_sort(order.begin(), order.end(), [&nesting](std::uint32_t a, std::uint32_t b) {
    return nesting.depth(a) < nesting.depth(b);
  });
  for (const std::uint32_t c : order) {
    const std::size_t depth = nesting.depth(c);
    bool turned = depth > 0 && facing[nesting.parent(c)] == Facing::inward;
    const bool negative_now = negative[c] != turned;
    if (depth % 2 == 0 && negative_now) turned = !turned;
    facing[c] = turned ? Facing::inward : Facing::fine;
  }
}

}  // namespace

std::vector<Facing> facing_of(const Mesh& mesh, const Components& components) {
  const std::vector<Shape> shapes = shapes_of(mesh, components);
  std::vector<Facing> facing(shapes.size(), Facing::fine);
  std::vector<bool> negative(shapes.size());
  for (std::size_t c = 0; c < shapes.size(); ++c) {
    if (!components.closed[c]) {
      facing[c] = facing_of_open(shapes[c]);
    } else {
      negative[c] = shapes[c].area > 0 && shapes[c].fullness() < -kLeastClosedFullness;
    }
  }
  if (std::find(negative.begin(), negative.end(), true) != negative.end()) {
    face_closed(mesh, components, negative, facing);
  }
  return facing;
}

}  // namespace palpate::bake
