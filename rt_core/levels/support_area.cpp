// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/support_area.hpp"

#include "rt_core/convex/support.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::levels {
namespace {

using convex::Hull;

double area_of(const Hull& hull, std::uint32_t vertex) noexcept {
  return static_cast<double>(hull.vertices[vertex].support_area);
}

/// Of a face of a hull.
struct Plane {
  Vec3d origin{};
  Vec3d normal{};  ///< of any length
  double within = 0;

  [[nodiscard]] bool holds(Vec3d point) const noexcept {
    return __builtin_fabs(dot(normal, point - origin)) <= within;
  }
};

Plane plane_through(Vec3d a, Vec3d b, Vec3d c) noexcept {
  const Vec3d normal = cross(b - a, c - a);
  return {a, normal, kFlat * norm(normal)};
}

/// Whether a triangle inside a face is not all of it. A vertex of the face that is not a corner of
/// the triangle is joined to one by an edge.
bool face_is_larger(const Hull& hull, const Plane& plane,
                    const std::uint32_t (&corners)[3]) noexcept {
  const auto is_another = [&](std::uint32_t v) {
    return v != corners[0] && v != corners[1] && v != corners[2] && plane.holds(position(hull, v));
  };
  if (hull.starts == nullptr) {
    for (std::uint32_t v = 0; v < hull.count; ++v) {
      if (is_another(v)) return true;
    }
    return false;
  }
  for (const std::uint32_t corner : corners) {
    for (std::uint32_t i = hull.starts[corner]; i < hull.starts[corner + 1]; ++i) {
      if (is_another(hull.neighbours[i])) return true;
    }
  }
  return false;
}

/// Of the triangles of a face that meet at one of its vertices, the apex, the one that holds a
/// point: its edges from the apex are those next to the ray from there through the point.
class Fan {
 public:
  /// @param ray  from the apex to the point
  Fan(Vec3d ray, Vec3d normal) noexcept : ray_(ray), normal_(normal) {}

  /// From the apex to any other vertex of the face: as it is convex, all lie within half a turn.
  /// @param rise  of the area along the edge
  void add(Vec3d edge, double rise) noexcept {
    const bool left = turn(ray_, edge) >= 0;
    Side& next = left ? left_ : right_;
    if (next.length2 == 0 || (turn(edge, next.edge) > 0) == left) {
      next = {edge, rise, squared_norm(edge)};
    }
  }

  /// Of the area along the ray.
  [[nodiscard]] double rise() const noexcept {
    const double whole = turn(right_.edge, left_.edge);
    if (whole > 0) {
      return left_.rise * (turn(right_.edge, ray_) / whole) +
             right_.rise * (turn(ray_, left_.edge) / whole);
    }
    // Rounding has put a point of the outermost edge outside.
    const Side& only = left_.length2 > 0 ? left_ : right_;
    return only.length2 > 0 ? only.rise * (dot(ray_, only.edge) / only.length2) : 0;
  }

 private:
  struct Side {
    Vec3d edge{};
    double rise = 0;
    double length2 = 0;  ///< 0: there is none
  };

  [[nodiscard]] double turn(Vec3d from, Vec3d to) const noexcept {
    return dot(cross(from, to), normal_);
  }

  Vec3d ray_;
  Vec3d normal_;
  Side left_;
  Side right_;
};

}  // namespace

double support_area(const Hull& hull, const Combination& witness) noexcept {
  const std::uint32_t(&corners)[3] = witness.vertices;
  double area = 0;
  Vec3d point{};
  for (std::uint32_t i = 0; i < witness.count; ++i) {
    area += witness.weights[i] * area_of(hull, corners[i]);
    point += witness.weights[i] * position(hull, corners[i]);
  }
  if (witness.count < 3 || hull.count == 3) return area;

  const Plane plane = plane_through(position(hull, corners[0]), position(hull, corners[1]),
                                    position(hull, corners[2]));
  if (!face_is_larger(hull, plane, corners)) return area;

  std::uint32_t apex = 0;
  while (apex + 1 < hull.count && !plane.holds(position(hull, apex))) ++apex;
  const Vec3d origin = position(hull, apex);
  const double at_apex = area_of(hull, apex);
  Fan fan(point - origin, plane.normal);
  for (std::uint32_t v = apex + 1; v < hull.count; ++v) {
    const Vec3d vertex = position(hull, v);
    if (plane.holds(vertex)) fan.add(vertex - origin, area_of(hull, v) - at_apex);
  }
  return at_apex + fan.rise();
}

}  // namespace palpate::levels
