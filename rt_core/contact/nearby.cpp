// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/nearby.hpp"

namespace palpate::contact {

SignedDistance signed_distance(const Target& target, Pace& pace, Vec3d x, std::uint32_t hint,
                               double limit) noexcept {
  const Surface& surface = target.surface;
  SignedDistance out;
  double radius = limit;
  const auto see = [&](std::uint32_t triangle) {
    const Foot foot = closest_point(surface, triangle, x);
    const bool nearer = out.foot.triangle == image::kNone ? foot.squared <= radius * radius
                                                          : foot.squared < out.foot.squared ||
                                                                (foot.squared == out.foot.squared &&
                                                                 triangle < out.foot.triangle);
    if (!nearer || squared_norm(face_normal(surface, triangle)) == 0) return;
    out.foot = foot;
    radius = sqrt_of(foot.squared);
  };
  if (hint != image::kNone) see(hint);
  for_each_near(target, pace, x, radius, see);
  if (out.foot.triangle == image::kNone) return out;
  const bool inside = dot(x - out.foot.point, pseudonormal(surface, out.foot)) < 0;
  out.value = inside ? -radius : radius;
  return out;
}

}  // namespace palpate::contact
