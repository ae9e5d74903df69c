// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/proximity.hpp"

namespace palpate::contact {
namespace {

constexpr double kRounding = 2e-6;
constexpr double kAnywhere = 1e18;

double larger(double a, double b) noexcept { return a > b ? a : b; }

/// The grid holds the surface. In the image's coordinates; 0 inside.
double distance_from_grid(const image::ProximityGrid& grid, Vec3d x) noexcept {
  const double at[3] = {x.x, x.y, x.z};
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<double>(grid.origin[axis]);
    const double high =
        low + static_cast<double>(grid.cell) * image::kBrickEdge * grid.bricks[axis];
    const double beyond = larger(larger(low - at[axis], at[axis] - high), 0);
    squared += beyond * beyond;
  }
  return sqrt_of(squared);
}

}  // namespace

double distance_bound(const Surface& surface, Vec3d x) noexcept {
  const Vec3d in_image = (1 / surface.scale) * x;
  const double slack = kRounding * (1 + norm(in_image));
  const double outside = distance_from_grid(*surface.image->proximity_grid, in_image);
  const double by_box =
      outside > 0 ? lipschitz_bound(surface, surface.scale * (outside - slack)) : -kAnywhere;
  const ProximityCell cell = cell_at(*surface.image, vec_cast<float>(in_image));
  if (squared_norm(face_normal(surface, cell.triangle)) == 0) return by_box;
  const Vec3d centre = surface.scale * vec_cast<double>(cell.centre);
  const double at_centre = lipschitz_bound(
      surface, signed_by(surface, closest_point(surface, cell.triangle, centre), centre));
  return larger(by_box, at_centre - norm(x - centre) - surface.scale * slack);
}

}  // namespace palpate::contact
