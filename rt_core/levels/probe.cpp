// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/probe.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

/// Rounding of the odometers and of float bounds, in units.
constexpr double kMotionSlack = 1e-9;
/// A query may stop once the pair is this many ticks of the present motion farther than delta: it
/// need then not be measured for as long.
constexpr double kFarTicks = 6;
/// With Schedule::exhaustive also at this share of delta: in fast motion a longer pause saves
/// queries, but costs more iterations than these would.
constexpr double kFarShare = 0.2;

/// Rounded towards minus infinity far enough for float.
float float_below(double v) noexcept { return static_cast<float>(v - 1e-7 * (v < 0 ? -v : v)); }

double motion(const PairState& pair, const Node& node) noexcept {
  return (pair.travel - node.travel_at) +
         (pair.turn - node.turn_at) * static_cast<double>(node.reach);
}

/// Both bounds as of now.
void renew(const PairState& pair, Node& node) noexcept {
  if (node.travel_at == pair.travel && node.turn_at == pair.turn) return;
  node.lower_bound = float_below(lower_bound_now(pair, node));
  node.certified = float_below(certified_now(pair, node));
  node.travel_at = pair.travel;
  node.turn_at = pair.turn;
}

/// Of the distance of what is below two overlapping hulls.
double overlap_bound(const PairState& pair, const Node& node) noexcept {
  const double spheres = sphere_distance(pair, piece_a(pair, node), piece_b(pair, node));
  return spheres < 0 ? spheres : 0;
}

convex::Hull culling_hull_of(const ImageView& image, const Piece& piece, double scale) noexcept {
  if (piece.culling_vertices == 0) return hull_of(image, piece, scale);
  convex::Hull hull;
  hull.vertices = image.culling_vertices.data() + piece.first_culling_vertex;
  hull.count = piece.culling_vertices;
  hull.scale = scale;
  return hull;
}

}  // namespace

double lower_bound_now(const PairState& pair, const Node& node) noexcept {
  return static_cast<double>(node.lower_bound) - motion(pair, node) - kMotionSlack;
}

double certified_now(const PairState& pair, const Node& node) noexcept {
  const double own = static_cast<double>(node.certified) - motion(pair, node) - kMotionSlack;
  return own > pair.apart ? own : pair.apart;
}

void prove(const PairState& pair, Node& node, double certified) noexcept {
  renew(pair, node);
  if (certified > static_cast<double>(node.certified)) node.certified = float_below(certified);
}

void set_lower_bound(const PairState& pair, Node& node, double lower_bound) noexcept {
  renew(pair, node);
  node.lower_bound = float_below(lower_bound);
}

void begin(const PairState& pair, Node& node, double inherited) noexcept {
  const Piece& a = piece_a(pair, node);
  const double reach =
      norm(centre_of(a, pair.scale_a)) + pair.scale_a * static_cast<double>(a.radius);
  node.reach = static_cast<float>(reach * (1 + 1e-6));
  const double spheres = sphere_distance(pair, a, piece_b(pair, node)) - kMotionSlack;
  node.lower_bound = float_below(spheres);
  node.certified = float_below(spheres > inherited ? spheres : inherited);
  node.travel_at = pair.travel;
  node.turn_at = pair.turn;
}

void Probe::note(const convex::Distance& d) noexcept {
  if (d.state == convex::State::gave_up) capped_ = true;
  tally_.count([&](auto& counters) {
    counters.iterations += d.iterations;
    counters.warm_queries += d.iterations <= 1 ? 1u : 0u;
  });
}

double Probe::far_margin(const PairState& pair, const Node& node) const noexcept {
  const double margin =
      kFarTicks * (pair.last_travel + pair.last_turn * static_cast<double>(node.reach));
  const double most = kFarShare * pair.delta;
  return schedule_ == Schedule::exhaustive && margin > most ? most : margin;
}

convex::Distance Probe::cull(const PairState& pair, Node& node, Ask ask) noexcept {
  if (rules_.bounds == Bounds::paper) return own(pair, node);
  charge(1);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  const double residual = pair.scale_a * static_cast<double>(a.culling_residual) +
                          pair.scale_b * static_cast<double>(b.culling_residual);
  const double reach = pair.delta + residual;
  const convex::Distance d = convex::distance(
      culling_hull_of(*pair.image_a, a, pair.scale_a),
      culling_hull_of(*pair.image_b, b, pair.scale_b), pair.b_in_a,
      {.above = reach + far_margin(pair, node),
       .below = ask == Ask::nearness && schedule_ == Schedule::exhaustive ? reach : 0},
      node.culling, vec_cast<double>(node.normal));
  note(d);
  tally_.count([](auto& counters) { ++counters.culling_queries; });
  if (node.contact == 0 && !overlaps(d)) node.normal = vec_cast<float>(d.normal);
  prove(pair, node, overlaps(d) ? overlap_bound(pair, node) : d.lower_bound - residual);
  return d;
}

convex::Distance Probe::own(const PairState& pair, Node& node) noexcept {
  charge(1);
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  const double h = pair.scale_a * static_cast<double>(a.hausdorff) +
                   pair.scale_b * static_cast<double>(b.hausdorff);
  const convex::Distance d = convex::distance(
      hull_of(*pair.image_a, a, pair.scale_a), hull_of(*pair.image_b, b, pair.scale_b), pair.b_in_a,
      {.above = pair.delta + h + far_margin(pair, node)}, node.own, vec_cast<double>(node.normal));
  note(d);
  tally_.count([](auto& counters) { ++counters.own_queries; });
  prove(pair, node, overlaps(d) ? overlap_bound(pair, node) : d.lower_bound - h);
  return d;
}

}  // namespace palpate::levels
