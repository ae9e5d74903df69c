// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/depths.hpp"

#include "rt_core/base/queue.hpp"
#include "rt_core/force/directions.hpp"

namespace palpate::force {
namespace {

// A direction is at most this far from the axis of its side: the corner of a cube.
constexpr double kCornerCosine = 0.57735026918962573;
constexpr double kCornerSine = 0.81649658092772603;
constexpr double kRoundingUp = 1 + 1e-12;
constexpr double kSameCosine = 1 - 1e-12;  // a microradian apart

struct Deeper {
  bool operator()(const Ranked& a, const Ranked& b) const noexcept {
    return a.depth_m > b.depth_m || (a.depth_m == b.depth_m && a.felt < b.felt);
  }
};

double magnitude(double v) noexcept { return v < 0 ? -v : v; }

int side_of(Vec3d n) noexcept {
  const double x = magnitude(n.x), y = magnitude(n.y), z = magnitude(n.z);
  if (x >= y && x >= z) return n.x < 0 ? 1 : 0;
  if (y >= z) return n.y < 0 ? 3 : 2;
  return n.z < 0 ? 5 : 4;
}

/// Cosine between a direction and the axis of a side.
double cosine_to(int side, Vec3d n) noexcept {
  const double along = side < 2 ? n.x : side < 4 ? n.y : n.z;
  return (side & 1) != 0 ? -along : along;
}

/// Largest kinship of a direction with any direction of a side.
double most_kinship(int side, Vec3d n) noexcept {
  const double c = cosine_to(side, n);
  if (c >= kCornerCosine) return 1;
  const double sine2 = 1 - c * c;
  const double nearest =
      kRoundingUp * (c * kCornerCosine + sqrt_of(sine2 > 0 ? sine2 : 0) * kCornerSine);
  if (nearest <= 0) return 0;
  return nearest < 1 ? kRoundingUp * kinship(nearest) : 1;
}

}  // namespace

Depths::Depths(std::span<Felt> felt, std::span<Ranked> ranking) noexcept : felt_(felt) {
  MinQueue<Ranked, Deeper> queue(ranking);
  for (std::uint32_t i = 0; i < felt.size(); ++i) queue.push({felt[i].depth_m, i});
  deepest_.fill(kNone);
  std::array<std::uint32_t, kSides> last{};
  for (; !queue.empty(); queue.pop()) {
    const std::uint32_t index = queue.top().felt;
    const auto side = static_cast<std::size_t>(side_of(felt[index].direction));
    felt[index].next = kNone;
    if (deepest_[side] == kNone) {
      deepest_[side] = index;
    } else {
      Felt& deeper = felt[last[side]];
      // It has nothing to say that the deeper one has not, and would use up looks.
      if (dot(deeper.direction, felt[index].direction) >= kSameCosine) continue;
      deeper.next = index;
    }
    last[side] = index;
  }
}

double Depths::around(const Felt& f) const noexcept {
  const int own = side_of(f.direction);
  double most_m = around(f, own, f.depth_m);
  for (int side = 0; side < kSides; ++side) {
    if (side != own) most_m = around(f, side, most_m);
  }
  return most_m;
}

double Depths::around(const Felt& f, int side, double most_m) const noexcept {
  std::uint32_t at = deepest_[static_cast<std::size_t>(side)];
  if (at == kNone || felt_[at].depth_m <= most_m) return most_m;
  const double kinship_there = most_kinship(side, f.direction);
  for (int look = 0; look < kMostLooks && at != kNone; ++look) {
    const Felt& other = felt_[at];
    if (other.depth_m * kinship_there <= most_m) break;
    const double cosine = dot(f.direction, other.direction);
    const double here_m = cosine > 0 ? kinship(cosine) * other.depth_m : 0;
    if (here_m > most_m) most_m = here_m;
    at = other.next;
  }
  return most_m;
}

}  // namespace palpate::force
