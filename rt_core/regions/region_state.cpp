// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/region_state.hpp"

#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {
namespace {

/// Rounding of the radius, and of the axes that it is a length along.
constexpr double kRadiusSlack = 1 + 1e-5;

/// Of a region, in the coordinates of a.
Vec3d centre_in_a(const levels::PairState& pair, std::uint32_t region) noexcept {
  const image::Region& r = pair.image_a->regions[region];
  const image::RegionNode& over = pair.image_a->region_nodes[r.parent];
  return pair.scale_a * Vec3d{static_cast<double>(over.centre[0][r.slot]),
                              static_cast<double>(over.centre[1][r.slot]),
                              static_cast<double>(over.centre[2][r.slot])};
}

/// From a point to the nearest on a way that starts at the origin.
double distance_to_way(Vec3d point, Vec3d way) noexcept {
  const double length2 = squared_norm(way);
  if (!(length2 > 0)) return norm(point);
  const double along = dot(point, way) / length2;
  return norm(point - (along < 0 ? 0 : along < 1 ? along : 1) * way);
}

}  // namespace

Vec3d centre_of(const levels::PairState& pair, std::uint32_t region) noexcept {
  return to_b(pair, centre_in_a(pair, region));
}

Vec3d step_of(const levels::PairState& pair, std::uint32_t region) noexcept {
  const Vec3d centre = centre_in_a(pair, region);
  const Vec3d before = pair.trail.rotation * centre + pair.trail.translation;
  return (1 / levels::kTrailTicks) * (to_b(pair, centre) - before);
}

Stand stand_of(const levels::PairState& pair, std::uint32_t region, Vec3d course) noexcept {
  return {centre_of(pair, region), course, pair.travel, pair.turn};
}

double moved_since(const Stand& at, const levels::PairState& pair, std::uint32_t region) noexcept {
  const double radius =
      kRadiusSlack * pair.scale_a * static_cast<double>(pair.image_a->regions[region].radius);
  return distance_to_way(centre_of(pair, region) - at.centre, at.course) +
         (pair.turn - at.turn) * radius + kMotionSlack;
}

void prove(RegionState& state, RegionPairs& kept, const levels::PairState& pair,
           std::uint32_t region, float rest, Vec3d course) noexcept {
  const NearPairs& near = kept.near;
  const float nearest = near.count > 0 ? near.pairs[0].distance - kRounding : rest;
  state.rest = rest;
  state.lower = nearest < rest ? nearest : rest;
  state.at = stand_of(pair, region, course);
  for (std::uint32_t k = 0; k < near.count; ++k) kept.apart[k] = near.pairs[k].distance;
}

}  // namespace palpate::regions
