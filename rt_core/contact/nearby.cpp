// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/nearby.hpp"

namespace palpate::contact {
namespace {

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

regions::Box box_of_segment(Vec3d from, Vec3d to) noexcept {
  const Vec3d along = to - from;
  const double length = norm(along);
  const Vec3d x = length > 0 ? (1 / length) * along : Vec3d{1, 0, 0};
  const double ax = x.x < 0 ? -x.x : x.x;
  constexpr double kAside = 0.8;  // where x is larger, y is less
  const Vec3d aside = cross(x, ax < kAside ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
  const Vec3d y = (1 / norm(aside)) * aside;
  const Vec3d z = cross(x, y);
  const Vec3d middle = 0.5 * (from + to);
  const auto row = [](float(&out)[4], double a, double b, double c, double d) {
    out[0] = static_cast<float>(a);
    out[1] = static_cast<float>(b);
    out[2] = static_cast<float>(c);
    out[3] = static_cast<float>(d);
  };
  regions::Box box{};
  row(box.x, x.x, y.x, z.x, middle.x);
  row(box.y, x.y, y.y, z.y, middle.y);
  row(box.z, x.z, y.z, z.z, middle.z);
  box.half[0] = static_cast<float>(0.5 * length);
  return box;
}

std::uint32_t near_boxes(const regions::Kernels& kernels, const regions::Box& box,
                         const image::RegionNode& node, float below,
                         float (&out_squared)[regions::kBatch]) noexcept {
  constexpr regions::Transform kSame = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, 1};
  constexpr float kUnit2 = 1;
  regions::BoxTest test;
  const std::uint32_t near =
      kernels.test_boxes(box, kSame, {}, node, kUnit2, below, regions::Order::any, test);
  for (std::uint32_t i = 0; i < regions::kBatch; ++i) out_squared[i] = test.squared[i];
  return near;
}

double signed_by(const Surface& surface, const Foot& foot, Vec3d x) noexcept {
  const double distance = sqrt_of(foot.squared);
  const bool behind = dot(x - foot.point, pseudonormal(surface, foot)) < 0;
  return behind && (!is_open(surface) || distance < open_depth(surface)) ? -distance : distance;
}

SignedDistance signed_distance(const Target& target, Pace& pace, Vec3d x,
                               std::uint32_t hint) noexcept {
  const Surface& surface = target.surface;
  SignedDistance out;
  double radius = kAnywhere;
  const auto see = [&](std::uint32_t triangle) {
    const Foot foot = closest_point(surface, triangle, x);
    if (foot.squared > radius * radius || !out.is_nearer(foot) ||
        squared_norm(face_normal(surface, triangle)) == 0) {
      return;
    }
    out.foot = foot;
    radius = sqrt_of(foot.squared);
  };
  if (hint != image::kNone) see(hint);
  for_each_near(target, pace, x, radius, see);
  if (out.foot.triangle != image::kNone) out.value = signed_by(surface, out.foot, x);
  return out;
}

double distance_bound(const Surface& surface, Vec3d x) noexcept {
  const Vec3d in_image = (1 / surface.scale) * x;
  const double slack = kFloatRounding * (1 + norm(in_image));
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
