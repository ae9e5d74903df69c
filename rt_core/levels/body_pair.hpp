// SPDX-License-Identifier: Apache-2.0
// Two bodies in their common unit: relative pose, motion since proofs, hulls of pieces.
#pragma once

#include <cstdint>
#include <limits>

#include "rt_core/convex/hull.hpp"
#include "rt_core/geometry/pose.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::levels {

/// Where the points x of a have been of late, in the coordinates of b: at rotation * x +
/// translation on the mean of the ticks so far, the last ones counting most. A mean of rotations,
/// which is none itself.
struct Trail {
  Mat3d rotation{};
  Vec3d translation{};
};

/// Lengths are in units of the larger body's radius, so that micrometre parts and kilometre
/// terrains are the same numbers. The coordinates of a body have their origin at its centre.
struct PairState {
  // Fixed.
  const ImageView* image_a = nullptr;
  const ImageView* image_b = nullptr;
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  double unit_m = 1;   ///< metres
  double scale_a = 1;  ///< units of a piece coordinate of a
  double scale_b = 1;
  /// The bodies' distance is within this of that of the surfaces that were baked.
  double deviation = 0;
  std::uint32_t root = 0;  ///< node of the two root pieces

  // This tick.
  RelativePose b_in_a;
  Mat3d rotation_a;     ///< body a to world
  Vec3d centre_a_m{};   ///< centre of a in the world
  double delta = 0;     ///< contact tolerance
  bool placed = false;  ///< a pose has been set before
  bool fresh = true;    ///< nothing is proved yet at any pose
  /// Lower bound of the distance of the two bodies, proved in this tick (levels engine).
  double apart = -std::numeric_limits<double>::infinity();
  double nearest = 0;  ///< least distance of the contacts so far, or delta (levels engine)

  // Odometers: how far a has moved relative to b, in all ticks. A point of a at distance x from its
  // centre has moved at most travel + turn * x since both were zero.
  double travel = 0;
  double turn = 0;
  double last_travel = 0;  ///< of the last move
  double last_turn = 0;
  Trail trail;
};

/// Sets the poses of this tick (unit quaternions) and advances the odometers.
void move(PairState& pair, const Pose& a, const Pose& b) noexcept;

/// Of how many ticks ago the trail is, in steady motion.
inline constexpr double kTrailTicks = 3;
/// Forgets the way that led here, as after a jump.
void leave_no_trail(PairState& pair) noexcept;

/// A point of a's coordinates in those of b.
inline Vec3d to_b(const PairState& pair, Vec3d point) noexcept {
  return transpose(pair.b_in_a.rotation) * (point - pair.b_in_a.translation);
}

/// Approximates the surface below it.
inline bool is_simplified(const image::Piece& piece) noexcept {
  return piece.surface_deviation > 0 || piece.hausdorff > 0;
}

convex::Hull hull_of(const ImageView& image, const image::Piece& piece, double scale) noexcept;

/// Centre of a piece's bounding sphere, in the coordinates of its body.
inline Vec3d centre_of(const image::Piece& piece, double scale) noexcept {
  return scale * vec3d(piece.centre);
}

/// Lower bound of the distance of two pieces from their bounding spheres; negative where these
/// overlap, and then no more than the depth by which the pieces can.
double sphere_distance(const PairState& pair, const image::Piece& a,
                       const image::Piece& b) noexcept;

}  // namespace palpate::levels
