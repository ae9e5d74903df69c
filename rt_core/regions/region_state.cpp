// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/region_state.hpp"

#include "rt_core/regions/pair_frame.hpp"

namespace palpate::regions {
namespace {

/// Rounding of the radius, and of the axes that it is a length along.
constexpr double kRadiusSlack = 1 + 1e-5;

/// Of a region, in the coordinates of b.
Vec3d centre_of(const levels::PairState& pair, std::uint32_t region) noexcept {
  const image::Region& r = pair.image_a->regions[region];
  const image::RegionNode& over = pair.image_a->region_nodes[r.parent];
  const Vec3d in_a = pair.scale_a * Vec3d{static_cast<double>(over.centre[0][r.slot]),
                                          static_cast<double>(over.centre[1][r.slot]),
                                          static_cast<double>(over.centre[2][r.slot])};
  return to_b(pair, in_a);
}

}  // namespace

Stand stand_of(const levels::PairState& pair, std::uint32_t region) noexcept {
  return {centre_of(pair, region), pair.travel, pair.turn};
}

double moved_since(const Stand& at, const levels::PairState& pair, std::uint32_t region) noexcept {
  const double radius =
      kRadiusSlack * pair.scale_a * static_cast<double>(pair.image_a->regions[region].radius);
  return norm(centre_of(pair, region) - at.centre) + (pair.turn - at.turn) * radius + kMotionSlack;
}

void prove(RegionState& state, const levels::PairState& pair, std::uint32_t region,
           float rest) noexcept {
  const float nearest = state.near.count > 0 ? state.near.pairs[0].distance - kRounding : rest;
  state.rest = rest;
  state.lower = nearest < rest ? nearest : rest;
  state.at = stand_of(pair, region);
  for (std::uint32_t k = 0; k < state.near.count; ++k) {
    state.apart[k] = state.near.pairs[k].distance;
  }
}

}  // namespace palpate::regions
