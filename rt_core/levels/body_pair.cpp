// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/body_pair.hpp"

namespace palpate::levels {
namespace {

Vec3d centre_in_body(const ImageView& image) noexcept {
  return {image.header->centre_m[0], image.header->centre_m[1], image.header->centre_m[2]};
}

/// a to b.
Trail inverse(const RelativePose& b_in_a) noexcept {
  const Mat3d back = transpose(b_in_a.rotation);
  return {back, -(back * b_in_a.translation)};
}

Vec3d mixed(Vec3d from, Vec3d to) noexcept {
  constexpr double kShare = 1 / (kTrailTicks + 1);
  return from + kShare * (to - from);
}

Trail mixed(const Trail& from, const Trail& to) noexcept {
  return {{mixed(from.rotation.row0, to.rotation.row0), mixed(from.rotation.row1, to.rotation.row1),
           mixed(from.rotation.row2, to.rotation.row2)},
          mixed(from.translation, to.translation)};
}

}  // namespace

void leave_no_trail(PairState& pair) noexcept { pair.trail = inverse(pair.b_in_a); }

void move(PairState& pair, const Pose& a, const Pose& b) noexcept {
  const Mat3d rotation_a = rotation(a.orientation);
  const Mat3d rotation_b = rotation(b.orientation);
  const Vec3d centre_a = a.position_m + rotation_a * centre_in_body(*pair.image_a);
  const Vec3d centre_b = b.position_m + rotation_b * centre_in_body(*pair.image_b);
  const Mat3d world_to_a = transpose(rotation_a);
  const RelativePose now{world_to_a * rotation_b,
                         world_to_a * ((1.0 / pair.unit_m) * (centre_b - centre_a))};

  pair.last_travel = 0;
  pair.last_turn = 0;
  if (pair.placed) {
    // Seen from b, the centre of a stands at -R^T t.
    const Vec3d before = transpose(pair.b_in_a.rotation) * pair.b_in_a.translation;
    const Vec3d after = transpose(now.rotation) * now.translation;
    pair.last_travel = norm(after - before);
    // The Frobenius norm of the difference of two rotations by theta is 2 sqrt(2) sin(theta / 2); a
    // point at distance 1 moves by at most 2 sin(theta / 2).
    const double square = squared_norm(now.rotation.row0 - pair.b_in_a.rotation.row0) +
                          squared_norm(now.rotation.row1 - pair.b_in_a.rotation.row1) +
                          squared_norm(now.rotation.row2 - pair.b_in_a.rotation.row2);
    pair.last_turn = sqrt_of(0.5 * square);
  }
  pair.travel += pair.last_travel;
  pair.turn += pair.last_turn;
  pair.b_in_a = now;
  pair.rotation_a = rotation_a;
  pair.centre_a_m = centre_a;
  pair.trail = pair.placed ? mixed(pair.trail, inverse(now)) : inverse(now);
  pair.placed = true;
}

convex::Hull hull_of(const ImageView& image, const image::Piece& piece, double scale) noexcept {
  convex::Hull hull;
  hull.vertices = image.vertices.data() + piece.first_vertex;
  hull.count = piece.hull_vertices;
  hull.scale = scale;
  if (piece.first_neighbour_start != image::kNone) {
    hull.starts = image.neighbour_starts.data() + piece.first_neighbour_start;
    hull.neighbours = image.neighbours.data() + piece.first_neighbour;
  }
  return hull;
}

double sphere_distance(const PairState& pair, const image::Piece& a,
                       const image::Piece& b) noexcept {
  const Vec3d centre_b =
      pair.b_in_a.rotation * centre_of(b, pair.scale_b) + pair.b_in_a.translation;
  return norm(centre_b - centre_of(a, pair.scale_a)) -
         pair.scale_a * static_cast<double>(a.radius) -
         pair.scale_b * static_cast<double>(b.radius);
}

}  // namespace palpate::levels
