// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/depths.hpp"

#include <array>

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

/// Lays the deepest of one side side by side; of the contacts, only `ranked` are of that side.
std::uint32_t keep_deepest(std::span<const Felt> felt, std::span<Ranked> ranked,
                           DeepLanes* lanes) noexcept {
  MinQueue<Ranked, Deeper> queue(ranked);
  queue.fill();
  std::uint32_t count = 0;
  Vec3d last{};
  for (; !queue.empty() && count < DeepSides::kMostLooks; queue.pop()) {
    const Felt& next = felt[queue.top().felt];
    // It has nothing to say that the deeper one has not, and would use up looks.
    if (count > 0 && dot(last, next.direction) >= kSameCosine) continue;
    last = next.direction;
    DeepLanes& to = lanes[count / DeepLanes::kLanes];
    const std::uint32_t lane = count % DeepLanes::kLanes;
    if (lane == 0) to = {};
    to.x[lane] = last.x;
    to.y[lane] = last.y;
    to.z[lane] = last.z;
    to.depth_m[lane] = next.depth_m;
    ++count;
  }
  return count;
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

Depths::Depths(std::span<const Felt> felt, std::span<Ranked> ranking, DeepSides& sides) noexcept
    : sides_(sides) {
  std::array<std::uint32_t, DeepSides::kSides + 1> end{};  // where the side before ends
  for (const Felt& f : felt) ++end[side_of(f.direction) + 1];
  for (std::uint32_t side = 0; side < DeepSides::kSides; ++side) end[side + 1] += end[side];
  for (std::uint32_t i = 0; i < felt.size(); ++i) {
    ranking[end[side_of(felt[i].direction)]++] = {felt[i].depth_m, i};
  }
  std::uint32_t first = 0;
  for (std::uint32_t side = 0; side < DeepSides::kSides; ++side) {
    const std::span<Ranked> ranked = ranking.subspan(first, end[side] - first);
    sides.count[side] = keep_deepest(felt, ranked, sides.lanes[side]);
    first = end[side];
  }
}

double Depths::around(const Felt& f) const noexcept {
  const std::uint32_t own = side_of(f.direction);
  double most_m = around(f, own, f.depth_m);
  for (std::uint32_t side = 0; side < DeepSides::kSides; ++side) {
    if (side != own) most_m = around(f, side, most_m);
  }
  return most_m;
}

double Depths::around(const Felt& f, std::uint32_t side, double most_m) const noexcept {
  const DeepLanes* lanes = sides_.lanes[side];
  const std::uint32_t count = sides_.count[side];
  if (count == 0 || lanes->depth_m[0] <= most_m) return most_m;
  const double kinship_there = most_kinship(side, f.direction);
  for (std::uint32_t i = 0; i < count; i += DeepLanes::kLanes, ++lanes) {
    if (lanes->depth_m[0] * kinship_there <= most_m) break;
    most_m = most_of(*lanes, f.direction, most_m);
  }
  return most_m;
}

}  // namespace palpate::force
