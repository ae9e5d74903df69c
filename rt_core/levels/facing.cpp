// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/facing.hpp"

#include "rt_core/geometry/angle.hpp"
#include "rt_core/levels/rules.hpp"

namespace palpate::levels {
namespace {

using image::Piece;
using image::PieceFlag;
using image::Triangle;

/// A point this near to a triangle of a patch lies on it. Baked vertices are rounded to 6e-8 and
/// hulls are checked against the mesh to 1e-7.
constexpr double kOnSurface = 1e-6;

double squared_distance_to_segment(Vec3d p, Vec3d from, Vec3d to) noexcept {
  const Vec3d along = to - from;
  const double length2 = squared_norm(along);
  double t = length2 > 0 ? dot(p - from, along) / length2 : 0;
  t = t < 0 ? 0 : (t > 1 ? 1 : t);
  return squared_norm(p - from - t * along);
}

bool on_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) noexcept {
  constexpr double kNear2 = kOnSurface * kOnSurface;
  const Vec3d normal = cross(b - a, c - a);
  const double area2 = squared_norm(normal);
  const double height = dot(p - a, normal);
  if (height * height > kNear2 * area2) return false;
  if (area2 > 0 && dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 &&
      dot(cross(a - c, p - c), normal) >= 0) {
    return true;
  }
  return squared_distance_to_segment(p, a, b) <= kNear2 ||
         squared_distance_to_segment(p, b, c) <= kNear2 ||
         squared_distance_to_segment(p, c, a) <= kNear2;
}

/// Cosine of the angle between a direction that leads out of a patch and its cone of normals: 1 in
/// the cone. `normal` is the piece's, in the coordinates of `outward`.
double cosine_to_cone(const Piece& piece, Vec3d normal, Vec3d outward) noexcept {
  const double length = norm(normal);
  const double cone = static_cast<double>(piece.patch_cosine);
  if (!(length > 0)) return 1;
  const double cosine = dot(outward, normal) / length;
  if (cosine >= cone) return 1;
  const double sines2 = (1 - cosine * cosine) * (1 - cone * cone);
  return cosine * cone + (sines2 > 0 ? sqrt_of(sines2) : 0);
}

}  // namespace

bool on_patch(const ImageView& image, const Piece& piece, Vec3d point) noexcept {
  if (has(piece, PieceFlag::all_real)) return true;
  const Triangle* triangles = image.triangles.data() + piece.first_triangle;
  const image::Vertex* vertices = image.vertices.data() + piece.first_vertex;
  for (std::uint32_t i = 0; i < piece.triangles; ++i) {
    const Triangle& t = triangles[i];
    if (on_triangle(point, vec3d(vertices[t.vertices[0]].position),
                    vec3d(vertices[t.vertices[1]].position),
                    vec3d(vertices[t.vertices[2]].position))) {
      return true;
    }
  }
  return false;
}

double facing(const PairState& pair, const Piece& a, const Piece& b, Vec3d direction) noexcept {
  const double of_a = cosine_to_cone(a, vec3d(a.patch_normal), -direction);
  const double of_b = cosine_to_cone(b, pair.b_in_a.rotation * vec3d(b.patch_normal), direction);
  return clamp01(of_a < of_b ? of_a : of_b);
}

}  // namespace palpate::levels
