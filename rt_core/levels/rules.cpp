// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/rules.hpp"

#include <limits>

#include "rt_core/levels/support_area.hpp"

namespace palpate::levels {
namespace {

using image::Piece;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double phi(const Piece& piece) noexcept {
  const double r = static_cast<double>(piece.resolution);
  return static_cast<double>(piece.surface_deviation) / (r * r);
}

/// 0 where there is nothing, infinity where nothing is allowed.
double ratio(double value, double allowed) noexcept {
  if (!(value > 0)) return 0;
  return allowed > 0 ? value / allowed : kInfinity;
}

double larger(double a, double b) noexcept { return a > b ? a : b; }

}  // namespace

Detail detail(const PairState& pair, const Piece& a, const Piece& b, const convex::Distance& query,
              const Rules& rules) noexcept {
  Detail out;
  if (convex::overlaps(query)) {
    out.refine_a = a.children != 0;
    out.refine_b = b.children != 0;
    out.s_star = out.refine_a || out.refine_b ? kInfinity : 0;
    return out;
  }
  const bool nothing_missing = a.surface_deviation == 0 && b.surface_deviation == 0;
  if (nothing_missing) return out;
  const double area_a = support_area(hull_of(*pair.image_a, a, pair.scale_a),
                                     {query.vertices_a, query.weights_a, query.count_a});
  const double area_b = support_area(hull_of(*pair.image_b, b, pair.scale_b),
                                     {query.vertices_b, query.weights_b, query.count_b});
  const double b_to_a = pair.scale_b / pair.scale_a;
  const double star_a = phi(a) / larger(area_a, area_b * b_to_a * b_to_a);
  const double star_b = phi(b) / larger(area_b, area_a / (b_to_a * b_to_a));
  const double excess_a =
      is_too_coarse(pair, a, pair.scale_a, rules) ? kInfinity : ratio(star_a, rules.s0);
  const double excess_b =
      is_too_coarse(pair, b, pair.scale_b, rules) ? kInfinity : ratio(star_b, rules.s0);
  out.s_star = larger(star_a, star_b);
  out.refine_a = excess_a > 1 && a.children != 0;
  out.refine_b = excess_b > 1 && b.children != 0;
  return out;
}

bool splits_a(const PairState& pair, const Piece& a, const Piece& b, bool may_a,
              bool may_b) noexcept {
  if (!may_a || !may_b) return may_a;
  const double child_a =
      static_cast<double>(pair.image_a->pieces[a.first_child].resolution) / pair.scale_a;
  const double child_b =
      static_cast<double>(pair.image_b->pieces[b.first_child].resolution) / pair.scale_b;
  if (child_a != child_b) return child_a < child_b;
  return pair.scale_a * static_cast<double>(a.radius) >=
         pair.scale_b * static_cast<double>(b.radius);
}

}  // namespace palpate::levels
