// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "host_bake/models/round.hpp"
#include "host_bake/models/shapes.hpp"

namespace palpate::bake {

Mesh ellipsoid(std::size_t triangles, std::uint64_t /*seed*/) {
  constexpr std::array<double, 3> kSemiAxes_m{0.020, 0.012, 0.008};
  const std::vector<Row> rows = plan_body(unit_sphere(), 0.0, 1.0, triangles / 2 + 2);
  // An affine image of a convex mesh is convex.
  const Surface surface = [&](double v) -> Curve {
    return [&, v](double u) {
      const Point d = direction(u, v);
      return Point{d[0] * kSemiAxes_m[0], d[1] * kSemiAxes_m[1], d[2] * kSemiAxes_m[2]};
    };
  };
  return loft(surface, rows, Ends::poles);
}

}  // namespace palpate::bake
