// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/surface_points.hpp"

#include <limits>

#include "host_bake/metrics/nearest_on_triangle.hpp"

namespace palpate::cli {
namespace {

Vec3d position(const image::Vertex& v) {
  return {double(v.position[0]), double(v.position[1]), double(v.position[2])};
}

/// Of the patch of a piece with triangles; all in piece coordinates.
Vec3d nearest_on_patch(const ImageView& image, const image::Piece& piece, Vec3d p) {
  const image::Vertex* vertices = image.vertices.data() + piece.first_vertex;
  Vec3d nearest = p;
  double least = std::numeric_limits<double>::infinity();
  for (const image::Triangle& t : image.triangles.subspan(piece.first_triangle, piece.triangles)) {
    const Vec3d q = bake::nearest_on_triangle(p, position(vertices[t.vertices[0]]),
                                              position(vertices[t.vertices[1]]),
                                              position(vertices[t.vertices[2]]));
    const double distance2 = squared_norm(p - q);
    if (distance2 < least) {
      least = distance2;
      nearest = q;
    }
  }
  return nearest;
}

Vec3d on_surface(const ImageView& image, std::uint32_t piece, const Pose& pose, Vec3d point_m) {
  const Mat3d turn = rotation(pose.orientation);
  const image::Header& h = *image.header;
  const Vec3d centre_m{h.centre_m[0], h.centre_m[1], h.centre_m[2]};
  const Vec3d p = (1 / h.radius_m) * (transpose(turn) * (point_m - pose.position_m) - centre_m);
  const Vec3d q = nearest_on_patch(image, image.pieces[piece], p);
  return turn * (h.radius_m * q + centre_m) + pose.position_m;
}

}  // namespace

std::span<const Contact> SurfacePoints::of(std::span<const Contact> contacts,
                                           std::span<const Pose> poses) {
  contacts_.assign(contacts.begin(), contacts.end());
  for (Contact& c : contacts_) {
    if (c.distance_m > 0) continue;
    const BodyPair& pair = pairs_[c.pair];
    c.point_a_m = on_surface(bodies_[pair.a], c.piece_a, poses[pair.a], c.point_a_m);
    c.point_b_m = on_surface(bodies_[pair.b], c.piece_b, poses[pair.b], c.point_b_m);
  }
  return contacts_;
}

}  // namespace palpate::cli
