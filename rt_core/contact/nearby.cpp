// SPDX-License-Identifier: Apache-2.0
#include "rt_core/contact/nearby.hpp"

namespace palpate::contact {

double signed_by(const Surface& surface, const Foot& foot, Vec3d x) noexcept {
  const double distance = sqrt_of(foot.squared);
  const bool behind = dot(x - foot.point, pseudonormal(surface, foot)) < 0;
  return behind && (!is_open(surface) || distance < open_depth(surface)) ? -distance : distance;
}

SignedDistance signed_distance(const Target& target, Pace& pace, Vec3d x, std::uint32_t hint,
                               double limit) noexcept {
  const Surface& surface = target.surface;
  SignedDistance out;
  double radius = limit;
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

}  // namespace palpate::contact
