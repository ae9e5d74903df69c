// SPDX-License-Identifier: Apache-2.0
// The points of one body of a pair against the surface of the other, at the poses of a tick.
#pragma once

#include <cstdint>

#include "rt_core/contact/found.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/palpate_rt.hpp"
#include "rt_core/regions/kernels.hpp"

namespace palpate::regions {

/// P's points against Q's surface; lengths in units of the pair unless a name says otherwise.
struct SideView {
  contact::Side side;
  contact::Target points;  ///< P as the target of queries
  Mat3d to_world{};        ///< turns Q's coordinates to the world
  Vec3d centre_m{};        ///< of Q
  double unit_m = 1;
  double odometer = 0;  ///< how far any point of either body has moved against the other, at most
  double delta = 0;
  std::uint32_t pair = 0;
  bool points_of_a = false;     ///< P is body a of the pair
  bool pushes_tool = false;     ///< the tool is one of the two bodies
  bool points_of_tool = false;  ///< P is the tool

  [[nodiscard]] const ImageView& image() const noexcept { return *side.points.image; }
  [[nodiscard]] Vec3d world(Vec3d point) const noexcept {
    return centre_m + unit_m * (to_world * point);
  }
  /// The axis, on the tool, of the pushes that face a cone of P's normals.
  [[nodiscard]] Vec3d push_axis(Vec3d normal_of_points) const noexcept {
    const Vec3d turned = to_world * side.turned_to_target(normal_of_points);
    return points_of_tool ? -turned : turned;
  }
};

/// @param points_of_a  P is body a of the pair, else body b
SideView view_of(const levels::PairState& pair, std::uint32_t index, const BodyPair& bodies,
                 std::uint32_t tool, bool points_of_a, const Kernels& kernels) noexcept;

/// Bounding sphere of a region of P, in P's coordinates.
struct Sphere {
  Vec3d centre{};
  double radius = 0;
};
Sphere sphere_of(const SideView& view, std::uint32_t region) noexcept;

}  // namespace palpate::regions
