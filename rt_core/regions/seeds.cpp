// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/seeds.hpp"

namespace palpate::regions {
namespace {

/// Of the region's radius: what is closer together is one place.
constexpr float kOnePlace = 0.125f;

bool same_place(const ImageView& a, const Witness& p, const Witness& q) noexcept {
  if (p.a == q.a || p.b == q.b) return true;
  const image::RegionTriangle& t = a.region_triangles[p.a];
  const image::RegionTriangle& u = a.region_triangles[q.a];
  const float x = t.corners[0] - u.corners[0];
  const float y = t.corners[1] - u.corners[1];
  const float z = t.corners[2] - u.corners[2];
  const float closest = kOnePlace * a.regions[t.region].radius;
  return x * x + y * y + z * z < closest * closest;
}

}  // namespace

void note_seed(const ImageView& a, const Witness& pair, Seeds& seeds) noexcept {
  std::uint32_t farthest = 0;
  for (std::uint32_t i = 0; i < seeds.count; ++i) {
    Witness& seed = seeds.at[i];
    if (same_place(a, seed, pair)) {
      if (pair.distance < seed.distance || seed.same_pair(pair)) seed = pair;
      return;
    }
    if (seed.distance > seeds.at[farthest].distance) farthest = i;
  }
  if (seeds.count < kSeeds) {
    seeds.at[seeds.count++] = pair;
  } else if (pair.distance < seeds.at[farthest].distance) {
    seeds.at[farthest] = pair;
  }
}

void move_seed(const ImageView& a, std::uint32_t index, const Witness& to, Seeds& seeds) noexcept {
  if (seeds.at[index].same_pair(to)) {
    seeds.at[index] = to;
    return;
  }
  seeds.at[index] = seeds.at[--seeds.count];
  note_seed(a, to, seeds);
}

}  // namespace palpate::regions
