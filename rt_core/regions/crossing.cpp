// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crossing.hpp"

#include "rt_core/convex/minkowski.hpp"

namespace palpate::regions {
namespace {

/// Normals that cancel to less than this share of the curve's length tell no direction.
constexpr double kLeastDecided = 1e-3;

Crossing crossing_of(const levels::PairState& pair, const CrossingPieces& pieces,
                     const convex::HullPair& hulls, convex::PenetrationScratch& scratch) noexcept {
  Crossing out;
  out.piece_a = pieces.a;
  out.piece_b = pieces.b;
  convex::Cache cache;
  const convex::Distance apart =
      convex::distance(hulls.a, hulls.b, pair.b_in_a, {.above = 0}, cache);
  if (apart.state == convex::State::separated) {  // by rounding: they touch
    out.depth = 0;
    out.point_a = apart.point_a;
    out.point_b = apart.point_b;
    out.normal = apart.normal;
    return out;
  }
  const convex::Penetration p = convex::penetration(hulls.a, hulls.b, pair.b_in_a, cache, scratch);
  out.depth = p.depth;
  out.point_a = p.point_a;
  out.point_b = p.point_b;
  out.normal = p.normal;
  out.exact = p.exact;
  return out;
}

/// How far a has to move along a way until a plane across it parts the two.
double depth_along(const convex::HullPair& hulls, Vec3d way) noexcept {
  const double depth = convex::farthest(hulls, (-1 / norm(way)) * way, {}).dot;
  return depth > 0 ? depth : 0;
}

/// Mostly the way along which the pieces part sooner.
Vec3d way_out(const CrossingCurve& curve, const convex::HullPair& hulls) noexcept {
  if (!(squared_norm(curve.along_a) > 0)) return curve.along_b;
  if (!(squared_norm(curve.along_b) > 0)) return curve.along_a;
  const double depth_a = depth_along(hulls, curve.along_a);
  const double depth_b = depth_along(hulls, curve.along_b);
  // Squares would leave a side of a box in a plate more than a ten-thousandth of its own way.
  const double far_a = depth_a * depth_a * depth_a;
  const double far_b = depth_b * depth_b * depth_b;
  const double share_b = far_a + far_b > 0 ? far_a / (far_a + far_b) : 0.5;
  return (1 - share_b) * curve.along_a + share_b * curve.along_b;
}

}  // namespace

Crossing overlap(const levels::PairState& pair, CrossingScratch& scratch) noexcept {
  Crossing out;
  Vec3d way = scratch.list.rest.along_a + scratch.list.rest.along_b;
  double length = scratch.list.rest.length;
  Vec3d moment = scratch.list.rest.moment;
  for (std::uint32_t i = 0; i < scratch.list.count; ++i) {
    const CrossingPieces& pieces = scratch.list.pieces[i];
    const convex::Hull a =
        levels::hull_of(*pair.image_a, pair.image_a->pieces[pieces.a], pair.scale_a);
    const convex::Hull b =
        levels::hull_of(*pair.image_b, pair.image_b->pieces[pieces.b], pair.scale_b);
    const convex::HullPair hulls{a, b, pair.b_in_a};
    const Crossing next = crossing_of(pair, pieces, hulls, scratch.polytope);
    if (next.depth > out.depth) out = next;
    way += way_out(pieces.curve, hulls);
    length += pieces.curve.length;
    moment += pieces.curve.moment;
  }
  const double decided = norm(way);
  if (decided <= kLeastDecided * length) return out;
  out.normal = (1 / decided) * way;
  const Vec3d middle = (1 / length) * moment;
  const Vec3d half = (0.5 * out.depth) * out.normal;
  out.point_a = middle - half;
  out.point_b = middle + half;
  return out;
}

}  // namespace palpate::regions
