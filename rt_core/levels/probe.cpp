// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/probe.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

/// Rounding of the odometers and of float bounds, in units.
constexpr double kMotionSlack = 1e-9;
/// A query may stop once the pair is this many ticks of the present motion farther than delta: it
/// then rests for as long.
constexpr double kRestTicks = 6;

/// Rounded towards minus infinity far enough for float.
float float_below(double v) noexcept { return static_cast<float>(v - 1e-7 * (v < 0 ? -v : v)); }

double rest_margin(const PairState& pair, const Node& node) noexcept {
  return kRestTicks * (pair.last_travel + pair.last_turn * static_cast<double>(node.reach));
}

bool overlaps(const convex::Distance& d) noexcept {
  return d.state == convex::State::penetrating || d.state == convex::State::touching;
}

convex::Hull culling_hull_of(const ImageView& image, const Piece& piece, double scale) noexcept {
  if (piece.culling_vertices == 0) return hull_of(image, piece, scale);
  convex::Hull hull;
  hull.vertices = image.culling_vertices.data() + piece.first_culling_vertex;
  hull.count = piece.culling_vertices;
  hull.scale = scale;
  return hull;
}

/// The cache holds vertices of one kind of hull; the other kind starts from the direction of the
/// spheres' centres.
void use_cache_for(const PairState& pair, Node& node, bool culling, const convex::Hull& a,
                   const convex::Hull& b) noexcept {
  const bool is_culling = (node.flags & kCacheOfCullingHulls) != 0;
  if (is_culling == culling && node.cache.count > 0) return;
  const Vec3d centre_b =
      pair.b_in_a.rotation * centre_of(piece_b(pair, node), pair.scale_b) + pair.b_in_a.translation;
  convex::seed(a, b, pair.b_in_a, centre_of(piece_a(pair, node), pair.scale_a) - centre_b,
               node.cache);
  if (culling) {
    set(node, kCacheOfCullingHulls);
  } else {
    clear(node, kCacheOfCullingHulls);
  }
}

}  // namespace

double lower_now(const PairState& pair, const Node& node) noexcept {
  return static_cast<double>(node.lower) - (pair.travel - node.travel_at) -
         (pair.turn - node.turn_at) * static_cast<double>(node.reach) - kMotionSlack;
}

void prove(const PairState& pair, Node& node, double lower) noexcept {
  if (lower <= lower_now(pair, node)) return;
  node.lower = float_below(lower);
  node.travel_at = pair.travel;
  node.turn_at = pair.turn;
}

void begin(const PairState& pair, Node& node, double inherited) noexcept {
  const Piece& a = piece_a(pair, node);
  const double reach =
      norm(centre_of(a, pair.scale_a)) + pair.scale_a * static_cast<double>(a.radius);
  node.reach = static_cast<float>(reach * (1 + 1e-6));
  const double spheres = sphere_distance(pair, a, piece_b(pair, node)) - kMotionSlack;
  node.lower = float_below(spheres > inherited ? spheres : inherited);
  node.travel_at = pair.travel;
  node.turn_at = pair.turn;
}

double overlap_bound(const PairState& pair, const Node& node) noexcept {
  const double spheres = sphere_distance(pair, piece_a(pair, node), piece_b(pair, node));
  return spheres < 0 ? spheres : 0;
}

double Probe::bound(const PairState& pair, Node& node) noexcept {
  if (rules_.bounds == Bounds::paper) {
    own(pair, node);
    return lower_now(pair, node);
  }
  charge(1);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  const convex::Hull hull_a = culling_hull_of(*pair.image_a, a, pair.scale_a);
  const convex::Hull hull_b = culling_hull_of(*pair.image_b, b, pair.scale_b);
  const double residual = pair.scale_a * static_cast<double>(a.culling_residual) +
                          pair.scale_b * static_cast<double>(b.culling_residual);
  use_cache_for(pair, node, true, hull_a, hull_b);
  const convex::Distance d = convex::distance(
      hull_a, hull_b, pair.b_in_a, pair.delta + residual + rest_margin(pair, node), node.cache);
  if (d.state == convex::State::gave_up) capped_ = true;
  if (node.contact == 0 && !overlaps(d)) node.witness_a = vec_cast<float>(d.normal);
  prove(pair, node, overlaps(d) ? overlap_bound(pair, node) : d.lower_bound - residual);
  return lower_now(pair, node);
}

convex::Distance Probe::own(const PairState& pair, Node& node) noexcept {
  charge(1);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  const convex::Hull hull_a = hull_of(*pair.image_a, a, pair.scale_a);
  const convex::Hull hull_b = hull_of(*pair.image_b, b, pair.scale_b);
  const double h = pair.scale_a * static_cast<double>(a.hausdorff) +
                   pair.scale_b * static_cast<double>(b.hausdorff);
  // Hulls without drift are their own culling hulls: one cache serves both.
  const bool same = a.culling_vertices == 0 && b.culling_vertices == 0;
  use_cache_for(pair, node, same && (node.flags & kCacheOfCullingHulls) != 0, hull_a, hull_b);
  const convex::Distance d = convex::distance(hull_a, hull_b, pair.b_in_a,
                                              pair.delta + h + rest_margin(pair, node), node.cache);
  if (d.state == convex::State::gave_up) capped_ = true;
  prove(pair, node, overlaps(d) ? overlap_bound(pair, node) : d.lower_bound - h);
  return d;
}

}  // namespace palpate::levels
