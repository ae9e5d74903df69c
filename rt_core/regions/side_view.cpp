// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/side_view.hpp"

namespace palpate::regions {

SideView view_of(const levels::PairState& pair, std::uint32_t index, const BodyPair& bodies,
                 std::uint32_t tool, bool points_of_a, const Kernels& kernels) noexcept {
  const contact::Surface a{pair.image_a, pair.scale_a};
  const contact::Surface b{pair.image_b, pair.scale_b};
  SideView out;
  out.points_of_a = points_of_a;
  out.pair = index;
  out.unit_m = pair.unit_m;
  out.delta = pair.delta;
  out.odometer = pair.travel + pair.turn * pair.scale_a * contact::kRoomForRounding;
  out.pushes_tool = bodies.a == tool || bodies.b == tool;
  out.points_of_tool = (points_of_a ? bodies.a : bodies.b) == tool;
  if (points_of_a) {
    const Mat3d back = transpose(pair.b_in_a.rotation);
    out.side = {a, {b, &kernels}, back, -(back * pair.b_in_a.translation)};
    out.points = {a, &kernels};
    out.to_world = pair.rotation_a * pair.b_in_a.rotation;
    out.centre_m = pair.centre_a_m + pair.unit_m * (pair.rotation_a * pair.b_in_a.translation);
  } else {
    out.side = {b, {a, &kernels}, pair.b_in_a.rotation, pair.b_in_a.translation};
    out.points = {b, &kernels};
    out.to_world = pair.rotation_a;
    out.centre_m = pair.centre_a_m;
  }
  return out;
}

Sphere sphere_of(const SideView& view, std::uint32_t region) noexcept {
  constexpr double kRoomForFloat = 1 + 1e-6;
  const contact::Surface& surface = view.side.points;
  const image::Region& r = surface.image->regions[region];
  const image::RegionNode& n = surface.image->region_nodes[r.parent];
  const auto at = [&](const float(&rows)[3][image::kRegionWidth]) {
    return Vec3d{static_cast<double>(rows[0][r.slot]), static_cast<double>(rows[1][r.slot]),
                 static_cast<double>(rows[2][r.slot])};
  };
  return {surface.scale * at(n.centre), surface.scale * norm(at(n.half)) * kRoomForFloat};
}

}  // namespace palpate::regions
