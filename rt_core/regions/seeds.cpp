// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/seeds.hpp"

namespace palpate::regions {
namespace {

/// Of the region's radius: what is closer together is one place.
constexpr float kOnePlace = 0.125f;

void put(const ImageView& a, const Witness& pair, std::uint32_t index, Seeds& seeds) noexcept {
  seeds.a[index] = pair.a;
  seeds.b[index] = pair.b;
  seeds.distance[index] = pair.distance;
  const image::RegionTriangle& t = a.region_triangles[pair.a];
  for (std::uint32_t k = 0; k < 3; ++k) seeds.corner[k][index] = t.corners[k];
}

/// The first of those in use for which `is(i)`; seeds.count: there is none. All that there is room
/// for are asked in lanes, without a branch, which would be guessed wrong.
template <class Is>
std::uint32_t first_where(const Seeds& seeds, Is is) noexcept {
  std::uint32_t first = kSeeds;
  for (std::uint32_t i = 0; i < kSeeds; ++i) {
    const std::uint32_t at = is(i) ? i : kSeeds;
    first = at < first ? at : first;
  }
  return first < seeds.count ? first : seeds.count;
}

std::uint32_t of_same_pair(const Witness& pair, const Seeds& seeds) noexcept {
  return first_where(
      seeds, [&](std::uint32_t i) { return ((seeds.a[i] ^ pair.a) | (seeds.b[i] ^ pair.b)) == 0; });
}

/// The first seed that is in a pair's place.
std::uint32_t in_place_of(const ImageView& a, const Witness& pair, const Seeds& seeds) noexcept {
  const image::RegionTriangle& t = a.region_triangles[pair.a];
  const float closest = kOnePlace * a.regions[t.region].radius;
  return first_where(seeds, [&](std::uint32_t i) {
    const float x = seeds.corner[0][i] - t.corners[0];
    const float y = seeds.corner[1][i] - t.corners[1];
    const float z = seeds.corner[2][i] - t.corners[2];
    const bool close = x * x + y * y + z * z < closest * closest;
    return (std::uint32_t{close} | std::uint32_t{seeds.a[i] == pair.a} |
            std::uint32_t{seeds.b[i] == pair.b}) != 0;
  });
}

std::uint32_t farthest_of(const Seeds& seeds) noexcept {
  std::uint32_t farthest = 0;
  for (std::uint32_t i = 1; i < seeds.count; ++i) {
    if (seeds.distance[i] > seeds.distance[farthest]) farthest = i;
  }
  return farthest;
}

}  // namespace

void note_seed(const ImageView& a, const Witness& pair, Seeds& seeds) noexcept {
  const std::uint32_t found = in_place_of(a, pair, seeds);
  if (found < seeds.count) {
    const Witness seed = seeds.at(found);
    if (pair.distance < seed.distance || seed.same_pair(pair)) put(a, pair, found, seeds);
  } else if (seeds.count < kSeeds) {
    put(a, pair, seeds.count++, seeds);
  } else if (const std::uint32_t farthest = farthest_of(seeds);
             pair.distance < seeds.distance[farthest]) {
    put(a, pair, farthest, seeds);
  }
}

bool measure_seed(const Witness& pair, Seeds& seeds) noexcept {
  const std::uint32_t found = of_same_pair(pair, seeds);
  if (found == seeds.count) return false;
  seeds.distance[found] = pair.distance;
  return true;
}

void move_seed(const ImageView& a, std::uint32_t index, const Witness& to, Seeds& seeds) noexcept {
  if (seeds.at(index).same_pair(to)) {
    seeds.distance[index] = to.distance;
    return;
  }
  put(a, seeds.at(--seeds.count), index, seeds);
  note_seed(a, to, seeds);
}

}  // namespace palpate::regions
