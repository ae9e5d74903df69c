// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/models/round.hpp"

#include <cmath>
#include <utility>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/trig.hpp"

namespace palpate::bake {
namespace {

Point scaled(const Point& p, double factor) {
  return {p[0] * factor, p[1] * factor, p[2] * factor};
}

/// The walls of a cup over one another: v in [0, rim] is the inner one, (rim, rim + kLip] the rim,
/// (rim + kLip, 2 rim + kLip] the outer one, back to the pole.
constexpr double kLip = 0.05;

/// How far the lip bulges over the rim's cone, in v.
constexpr double kBulge = 0.02;

Curve cup_curve(const Radius& inner, const Radius& outer, double rim, double v) {
  if (v <= rim) {
    return [=](double u) {
      const Point d = direction(u, v);
      return scaled(d, inner(d));
    };
  }
  if (v <= rim + kLip) {
    const double share = (v - rim) / kLip;
    return [=](double u) {
      const Point d = direction(u, rim + kBulge * 4.0 * share * (1.0 - share));
      return scaled(d, mix(inner(d), outer(d), share));
    };
  }
  return [=](double u) {
    const Point d = direction(u, 2.0 * rim + kLip - v);
    return scaled(d, outer(d));
  };
}

}  // namespace

Point direction(double u, double v) {
  // Exact at the poles, where every u has to give the same point.
  const double across = v <= 0.0 || v >= 1.0 ? 0.0 : sin_turns(0.5 * v);
  return {across * cos_turns(u), across * sin_turns(u), -cos_turns(0.5 * v)};
}

Surface star_surface(Radius radius) {
  return [radius = std::move(radius)](double v) -> Curve {
    return [&radius, v](double u) {
      const Point d = direction(u, v);
      return scaled(d, radius(d));
    };
  };
}

Surface unit_sphere() {
  return star_surface([](const Point&) { return 1.0; });
}

Mesh cup(const Radius& inner, const Radius& outer, std::span<const Row> inner_rows,
         std::size_t vertices) {
  const double rim = inner_rows.back().v;
  const Surface surface = [&](double v) { return cup_curve(inner, outer, rim, v); };
  std::vector<Row> rows(inner_rows.begin(), inner_rows.end());
  for (const Row& row : inner_rows) vertices -= row.count;
  append(rows, plan_rows(surface, rim, 2.0 * rim + kLip, vertices, Last::pole));
  return loft(surface, rows, Ends::poles);
}

}  // namespace palpate::bake
