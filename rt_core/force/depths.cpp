// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/depths.hpp"

#include "rt_core/force/directions.hpp"

namespace palpate::force {
namespace {

// A direction is at most this far from the axis of its side: the corner of a cube.
constexpr double kCornerCosine = 0.57735026918962573;
constexpr double kCornerSine = 0.81649658092772603;
constexpr double kRoundingUp = 1 + 1e-12;
constexpr double kSameCosine = 1 - 1e-12;  // a microradian apart

double magnitude(double v) noexcept { return v < 0 ? -v : v; }

std::uint32_t side_of(Vec3d n) noexcept {
  const double x = magnitude(n.x), y = magnitude(n.y), z = magnitude(n.z);
  if (x >= y && x >= z) return n.x < 0 ? 1 : 0;
  if (y >= z) return n.y < 0 ? 3 : 2;
  return n.z < 0 ? 5 : 4;
}

/// Cosine between a direction and the axis of a side.
double cosine_to(std::uint32_t side, Vec3d n) noexcept {
  const double along = side < 2 ? n.x : side < 4 ? n.y : n.z;
  return (side & 1) != 0 ? -along : along;
}

/// Largest kinship of a direction with any direction of a side.
double most_kinship(std::uint32_t side, Vec3d n) noexcept {
  const double c = cosine_to(side, n);
  if (c >= kCornerCosine) return 1;
  const double sine2 = 1 - c * c;
  const double nearest =
      kRoundingUp * (c * kCornerCosine + sqrt_of(sine2 > 0 ? sine2 : 0) * kCornerSine);
  if (nearest <= 0) return 0;
  return nearest < 1 ? kRoundingUp * kinship(nearest) : 1;
}

/// What every 64-bit target computes at once, in the same bits as one by one.
using Two = double __attribute__((vector_size(2 * sizeof(double))));

Two load(const double* from) noexcept {
  Two v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

/// Largest depth times kinship of a direction with those side by side, and `most_m`.
double most_of(const DeepLanes& lanes, Vec3d n, double most_m) noexcept {
  Two most{};
  for (std::uint32_t i = 0; i < DeepLanes::kLanes; i += 2) {
    const Two cosine = n.x * load(lanes.x + i) + n.y * load(lanes.y + i) + n.z * load(lanes.z + i);
    const Two here_m = kinship(cosine > 0.0 ? cosine : Two{}) * load(lanes.depth_m + i);
    most = here_m > most ? here_m : most;
  }
  most_m = most[0] > most_m ? most[0] : most_m;
  return most[1] > most_m ? most[1] : most_m;
}

}  // namespace

Depths::Depths(std::span<Felt> felt, std::span<Ranked> ranking, DeepSides& sides) noexcept
    : felt_(felt), sides_(sides) {
  std::array<std::uint32_t, DeepSides::kSides + 1> end{};  // where the side before ends
  for (Felt& f : felt) {
    f.side = side_of(f.direction);
    ++end[f.side + 1];
  }
  for (std::uint32_t side = 0; side < DeepSides::kSides; ++side) end[side + 1] += end[side];
  for (std::uint32_t i = 0; i < felt.size(); ++i) {
    ranking[end[felt[i].side]++] = {felt[i].depth_m, i};
  }
  std::uint32_t first = 0;
  for (std::uint32_t side = 0; side < DeepSides::kSides; ++side) {
    of_side_[side].waiting = MinQueue<Ranked, Deeper>(ranking.subspan(first, end[side] - first));
    of_side_[side].waiting.fill();
    first = end[side];
  }
}

double Depths::around(const Felt& f) noexcept {
  double most_m = around(f, f.side, f.depth_m);
  for (std::uint32_t side = 0; side < DeepSides::kSides; ++side) {
    if (side != f.side) most_m = around(f, side, most_m);
  }
  return most_m;
}

double Depths::around(const Felt& f, std::uint32_t side, double most_m) noexcept {
  Side& of = of_side_[side];
  DeepLanes* lanes = sides_.lanes[side];
  if (of.count == 0) lay(of, *lanes);
  if (of.count == 0 || lanes->depth_m[0] <= most_m) return most_m;
  const double kinship_there = most_kinship(side, f.direction);
  for (std::uint32_t i = 0; i < DeepSides::kMostLooks; i += DeepLanes::kLanes, ++lanes) {
    if (i == of.count) lay(of, *lanes);
    if (i >= of.count || lanes->depth_m[0] * kinship_there <= most_m) break;
    most_m = most_of(*lanes, f.direction, most_m);
  }
  return most_m;
}

/// The deepest that wait, as many as are looked at at once.
void Depths::lay(Side& of, DeepLanes& to) noexcept {
  for (std::uint32_t lane = 0; lane < DeepLanes::kLanes && !of.waiting.empty(); of.waiting.pop()) {
    const Felt& next = felt_[of.waiting.top().felt];
    // It has nothing to say that the deeper one has not, and would use up looks.
    if (of.count > 0 && dot(of.last, next.direction) >= kSameCosine) continue;
    of.last = next.direction;
    if (lane == 0) to = {};
    to.x[lane] = of.last.x;
    to.y[lane] = of.last.y;
    to.z[lane] = of.last.z;
    to.depth_m[lane] = next.depth_m;
    ++lane;
    ++of.count;
  }
}

}  // namespace palpate::force
