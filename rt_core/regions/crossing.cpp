// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/crossing.hpp"

#include <span>

#include "rt_core/convex/minkowski.hpp"
#include "rt_core/geometry/smooth_step.hpp"
#include "rt_core/levels/facing.hpp"

namespace palpate::regions {
namespace {

/// Normals that cancel to less than this share of the curve's length tell no direction.
constexpr double kLeastDecided = 1e-3;
/// Of delta: surfaces that cross in a shorter curve have only just begun to.
constexpr double kShortCurve = 0.5;

struct Hulls {
  convex::Hull a;
  convex::Hull b;
};

Hulls hulls_of(const levels::PairState& pair, std::uint32_t a, std::uint32_t b) noexcept {
  return {levels::hull_of(*pair.image_a, pair.image_a->pieces[a], pair.scale_a),
          levels::hull_of(*pair.image_b, pair.image_b->pieces[b], pair.scale_b)};
}

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

/// The cosine of the way that pieces are led out with `way`, which is unit; 1 where they tell none.
double agreement(const CrossingOfPieces& pieces, Vec3d way) noexcept {
  const double length = norm(pieces.way);
  return length > 0 ? dot(pieces.way, way) / length : 1;
}

/// Depths as they count along `way`. A box in a slot is as deep in the floor as the floor says,
/// however deep it is in the wall: all of a depth where the cosine is seven tenths of the largest,
/// and nothing where it is two tenths.
void count_along(std::span<CrossingOfPieces> pieces, Vec3d way) noexcept {
  constexpr double kNone = 0.2;
  constexpr double kAll = 0.7;
  double most = 0;
  for (const CrossingOfPieces& p : pieces) {
    const double cosine = agreement(p, way);
    most = cosine > most ? cosine : most;
  }
  if (!(most > 0)) return;  // outweighed by pieces for which there was no room
  for (CrossingOfPieces& p : pieces) {
    p.overlap.depth *= smooth_step((agreement(p, way) / most - kNone) / (kAll - kNone));
  }
}

const Crossing& deepest_of(std::span<const CrossingOfPieces> pieces) noexcept {
  const CrossingOfPieces* deepest = pieces.data();
  for (const CrossingOfPieces& p : pieces) {
    if (p.overlap.depth > deepest->overlap.depth) deepest = &p;
  }
  return deepest->overlap;
}

/// The way that pieces came which have only just met: their least way out, the deeper the more it
/// counts. Unit, or shorter the less they have only just met and the less they agree.
class WayBack {
 public:
  void add(const levels::PairState& pair, const Crossing& overlap) noexcept {
    constexpr double kLeastDepth = 1e-9;  // of pieces that touch
    const double as_met = levels::just_met(pair, pair.image_a->pieces[overlap.piece_a],
                                           pair.image_b->pieces[overlap.piece_b],
                                           {overlap.normal, overlap.point_a, overlap.depth});
    const double depth = overlap.depth + kLeastDepth;
    const double weight = depth * depth * depth;
    sum_ += (weight * as_met) * overlap.normal;
    weights_ += weight;
  }
  Vec3d way() const noexcept { return weights_ > 0 ? (1 / weights_) * sum_ : Vec3d{}; }

 private:
  Vec3d sum_{};
  double weights_ = 0;
};

/// Who has a part in a depth, not by chance where several are as deep: the pieces that are deeper
/// than nine tenths of it. For those, how long their way is.
void take_part(const levels::PairState& pair, std::span<CrossingOfPieces> pieces, double depth,
               Vec3d way) noexcept {
  double sum = 0;
  for (CrossingOfPieces& p : pieces) {
    p.part = depth > 0 ? smooth_step(10 * p.overlap.depth / depth - 9) : 0;
    sum += p.part;
  }
  for (CrossingOfPieces& p : pieces) {
    if (!(p.part > 0)) continue;
    p.part /= sum;
    const Hulls of = hulls_of(pair, p.overlap.piece_a, p.overlap.piece_b);
    p.way_length = depth_along({of.a, of.b, pair.b_in_a}, way);
  }
}

}  // namespace

Crossing overlap(const levels::PairState& pair, CrossingScratch& scratch) noexcept {
  const CrossingList& list = scratch.list;
  CrossingCurve all = list.rest;
  Vec3d way = all.along_a + all.along_b;
  const double short_curve = kShortCurve * pair.delta;
  WayBack way_back;
  const std::span<CrossingOfPieces> found{scratch.of_pieces, list.count};
  for (std::uint32_t i = 0; i < list.count; ++i) {
    const CrossingPieces& pieces = list.pieces[i];
    const Hulls of = hulls_of(pair, pieces.a, pieces.b);
    const convex::HullPair hulls{of.a, of.b, pair.b_in_a};
    found[i] = {crossing_of(pair, pieces, hulls, scratch.polytope), way_out(pieces.curve, hulls)};
    way += found[i].way;
    all.length += pieces.curve.length;
    all.moment += pieces.curve.moment;
    if (all.length < short_curve) way_back.add(pair, found[i].overlap);
  }
  const Vec3d back = (1 - smooth_step(all.length / short_curve)) * way_back.way();
  way = (1 - norm(back)) * way + norm(way) * back;
  const double decided = norm(way);
  if (decided <= kLeastDecided * all.length) return deepest_of(found);
  const Vec3d normal = (1 / decided) * way;
  count_along(found, normal);
  Crossing out = deepest_of(found);
  out.normal = normal;
  const Vec3d middle = (1 / all.length) * all.moment;
  const Vec3d half = (0.5 * out.depth) * out.normal;
  out.point_a = middle - half;
  out.point_b = middle + half;
  take_part(pair, found, out.depth, normal);
  return out;
}

}  // namespace palpate::regions
