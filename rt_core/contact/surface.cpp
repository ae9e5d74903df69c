// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/surface.hpp"

#include "rt_core/image/triangle_normal.hpp"

namespace palpate::contact {
namespace {

constexpr double kConvexCosine = 0.999999995;   // of 1e-4 rad
constexpr double kConcaveCosine = 0.999999995;  // of 1e-4 rad
/// Normals nearer together span no arc.
constexpr double kNoArc = 1e-12;

Vec3d unit(Vec3d v) noexcept {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3d{};
}

}  // namespace

Vec3d corner(const Surface& surface, std::uint32_t triangle, std::uint32_t i) noexcept {
  return surface.scale * vec3d(surface.image->region_triangles[triangle].corners + 3 * i);
}

Vec3d position(const Surface& surface, std::uint32_t vertex) noexcept {
  return surface.scale * vec3d(surface.image->surface_vertices[vertex].position);
}

std::uint32_t vertex_of(const Surface& surface, std::uint32_t triangle, std::uint32_t i) noexcept {
  return surface.image->triangle_vertices[triangle].corner[i];
}

std::uint32_t neighbour_of(const Surface& surface, std::uint32_t triangle,
                           std::uint32_t side) noexcept {
  return surface.image->region_triangles[triangle].neighbours[side];
}

Foot closest_point(const Surface& surface, std::uint32_t triangle, Vec3d x) noexcept {
  const Vec3d a = corner(surface, triangle, 0);
  const Vec3d b = corner(surface, triangle, 1);
  const Vec3d c = corner(surface, triangle, 2);
  const auto at = [&](Vec3d point, Feature feature) {
    return Foot{point, squared_norm(x - point), triangle, feature};
  };
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const double d1 = dot(ab, x - a);
  const double d2 = dot(ac, x - a);
  if (d1 <= 0 && d2 <= 0) return at(a, Feature::corner0);
  const double d3 = dot(ab, x - b);
  const double d4 = dot(ac, x - b);
  if (d3 >= 0 && d4 <= d3) return at(b, Feature::corner1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(a + (d1 / (d1 - d3)) * ab, Feature::edge0);
  const double d5 = dot(ab, x - c);
  const double d6 = dot(ac, x - c);
  if (d6 >= 0 && d5 <= d6) return at(c, Feature::corner2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(a + (d2 / (d2 - d6)) * ac, Feature::edge2);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return at(b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b), Feature::edge1);
  }
  const double inverse = 1 / (va + vb + vc);
  return at(a + (vb * inverse) * ab + (vc * inverse) * ac, Feature::face);
}

Vec3d face_normal(const Surface& surface, std::uint32_t triangle) noexcept {
  return image::normal_of(surface.image->region_triangles[triangle]);
}

namespace {

Vec3d pseudonormal_at(const Surface& surface, std::uint32_t triangle, std::uint32_t i) noexcept {
  return vec3d(surface.image->surface_vertices[vertex_of(surface, triangle, i)].pseudonormal);
}

/// Whether a triangle may cross others: none of its vertices has a pseudonormal then.
bool may_cross(const Surface& surface, std::uint32_t triangle) noexcept {
  const auto crossing = static_cast<std::uint32_t>(image::HeaderFlag::self_crossing);
  if ((surface.image->header->flags & crossing) == 0) return false;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (squared_norm(pseudonormal_at(surface, triangle, i)) > 0) return false;
  }
  return true;
}

}  // namespace

Vec3d pseudonormal(const Surface& surface, const Foot& foot) noexcept {
  const std::uint32_t i = which(foot.feature);
  if (is_corner(foot.feature)) return pseudonormal_at(surface, foot.triangle, i);
  if (may_cross(surface, foot.triangle)) return {};
  if (foot.feature == Feature::face) return face_normal(surface, foot.triangle);
  const std::uint32_t beyond = neighbour_of(surface, foot.triangle, i);
  const Vec3d own = face_normal(surface, foot.triangle);
  if (beyond == image::kNone || may_cross(surface, beyond)) return {};
  return own + face_normal(surface, beyond);
}

namespace {

/// Lets a direction's nearest place within an arc win, where it has one.
/// @param across  cross(from, to)
void see_arc(Vec3d direction, Vec3d from, Vec3d to, Vec3d across, NearestNormal& out) noexcept {
  const double sine2 = squared_norm(across);
  if (sine2 < kNoArc * kNoArc) return;
  if (dot(direction, cross(across, from)) < 0 || dot(direction, cross(to, across)) < 0) return;
  const Vec3d within = direction - (dot(direction, across) / sine2) * across;
  const double length = norm(within);
  if (length > out.cosine) out = {(1 / length) * within, length};
}

void see_corner(Vec3d direction, Vec3d normal, NearestNormal& out) noexcept {
  const double cosine = dot(direction, normal);
  if (cosine > out.cosine) out = {normal, cosine};
}

}  // namespace

NearestNormal nearest_on_arc(Vec3d direction, Vec3d from, Vec3d to) noexcept {
  NearestNormal out{to, dot(direction, to)};
  see_corner(direction, from, out);
  see_arc(direction, from, to, cross(from, to), out);
  return out;
}

NearestNormal nearest_at_vertex(const Surface& surface, std::uint32_t vertex,
                                Vec3d towards) noexcept {
  const image::SurfaceVertex& v = surface.image->surface_vertices[vertex];
  if (v.hull_normals == 0) return {towards, 1};
  const auto hull = surface.image->vertex_normals.subspan(v.first_normal, v.hull_normals);
  NearestNormal out;
  for (const image::SurfaceNormal& n : hull) see_corner(towards, direction(n), out);
  if (hull.size() == 1) return out;
  bool inside = hull.size() > 2;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec3d from = direction(hull[i]);
    const Vec3d to = direction(hull[i + 1 < hull.size() ? i + 1 : 0]);
    const Vec3d across = cross(from, to);
    // The nearest place is on an arc that the direction is beyond. Two normals have one arc.
    if (dot(towards, across) >= 0 && hull.size() > 2) continue;
    inside = false;
    see_arc(towards, from, to, across, out);
  }
  return inside ? NearestNormal{towards, 1} : out;
}

NearestNormal nearest_at(const Surface& surface, const Foot& foot, Vec3d towards) noexcept {
  const std::uint32_t i = which(foot.feature);
  if (is_corner(foot.feature)) {
    return nearest_at_vertex(surface, vertex_of(surface, foot.triangle, i), towards);
  }
  const Vec3d own = face_normal(surface, foot.triangle);
  if (is_edge(foot.feature)) {
    const std::uint32_t beyond = neighbour_of(surface, foot.triangle, i);
    const Vec3d other = beyond == image::kNone ? own : face_normal(surface, beyond);
    if (squared_norm(other) > 0) return nearest_on_arc(towards, own, other);
  }
  return {own, dot(towards, own)};
}

Edge edge_of(const Surface& surface, std::uint32_t name) noexcept {
  const std::uint32_t triangle = name / 3;
  const std::uint32_t side = name % 3;
  Edge out;
  out.from = corner(surface, triangle, side);
  out.to = corner(surface, triangle, (side + 1) % 3);
  out.normal = out.other_normal = face_normal(surface, triangle);
  const std::uint32_t beyond = neighbour_of(surface, triangle, side);
  if (beyond == image::kNone) return out;
  const Vec3d other = face_normal(surface, beyond);
  if (!(squared_norm(other) > 0) || !(squared_norm(out.normal) > 0)) return out;
  out.other_normal = other;
  const double cosine = dot(out.normal, other);
  std::uint32_t opposite = 0;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t vertex = vertex_of(surface, beyond, i);
    if (vertex != vertex_of(surface, triangle, side) &&
        vertex != vertex_of(surface, triangle, (side + 1) % 3)) {
      opposite = i;
    }
  }
  const double height = dot(corner(surface, beyond, opposite) - out.from, out.normal);
  out.convex = height < 0 && cosine < kConvexCosine;
  out.concave = height > 0 && cosine < kConcaveCosine;
  return out;
}

std::span<const image::SurfaceNormal> concave_normals(const Surface& surface,
                                                      std::uint32_t vertex) noexcept {
  const image::SurfaceVertex& v = surface.image->surface_vertices[vertex];
  return surface.image->vertex_normals.subspan(std::size_t{v.first_normal} + v.hull_normals,
                                               v.concave_normals);
}

NormalCone cone_of_vertex(const Surface& surface, std::uint32_t vertex) noexcept {
  const image::SurfaceVertex& v = surface.image->surface_vertices[vertex];
  NormalCone out{vec3d(v.pseudonormal), 1};
  if (v.hull_normals == 0 || !(squared_norm(out.axis) > 0)) return {};
  for (const image::SurfaceNormal& n :
       surface.image->vertex_normals.subspan(v.first_normal, v.hull_normals)) {
    const double cosine = dot(out.axis, direction(n));
    out.cosine = cosine < out.cosine ? cosine : out.cosine;
  }
  return out;
}

NormalCone cone_of_edge(const Edge& edge) noexcept {
  const Vec3d axis = unit(edge.normal + edge.other_normal);
  if (!(squared_norm(axis) > 0)) return {};
  return {axis, dot(axis, edge.normal)};
}

}  // namespace palpate::contact
