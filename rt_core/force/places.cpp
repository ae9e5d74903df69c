// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/places.hpp"

namespace palpate::force {
namespace {

/// Beyond that a corner finds no room. Half full, tables of thousands take up to 50.
constexpr int kMostProbes = 128;

/// Less than this may be rounding, and then which corner it goes to is chance.
constexpr double kLeastShare = 1e-9;

/// Corners farther out than this have no number; the masses of contacts there are kept.
constexpr double kFarthest = 1 << 30;

std::int32_t floor_of(double v) noexcept {
  const auto towards_zero = static_cast<std::int32_t>(v);
  return v < towards_zero ? towards_zero - 1 : towards_zero;
}

double least(double a, double b) noexcept { return a < b ? a : b; }
double most(double a, double b) noexcept { return a > b ? a : b; }

std::size_t count(bool a, bool b) noexcept { return std::size_t{a} + std::size_t{b}; }

bool numbered(double v) noexcept { return v > -kFarthest && v < kFarthest; }  // false for NaN

std::uint32_t hash_of(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
  std::uint64_t h = static_cast<std::uint32_t>(x) * 0x9e3779b97f4a7c15u;
  h = (h ^ static_cast<std::uint32_t>(y)) * 0xc2b2ae3d27d4eb4fu;
  h = (h ^ h >> 29 ^ static_cast<std::uint32_t>(z)) * 0x165667b19e3779f9u;
  return static_cast<std::uint32_t>(h >> 32);
}

}  // namespace

void Places::begin(double width_m, std::size_t contacts) noexcept {
  const std::size_t roomy = room_for(contacts);
  in_use_ = roomy < table_.size() ? roomy : table_.size();
  per_m_ = width_m > 0 ? 1 / width_m : 0;
  full_ = false;
  if (++tick_ != 0) return;
  for (Place& place : table_) place.tick = 0;  // the count came round: old marks must not match
  tick_ = 1;
}

std::uint32_t Places::find(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
  auto at =
      static_cast<std::uint32_t>((static_cast<std::uint64_t>(hash_of(x, y, z)) * in_use_) >> 32);
  for (int probe = 0; probe < kMostProbes; ++probe) {
    Place& place = table_[at];
    if (place.tick != tick_) {
      place = {x, y, z, tick_, 0, 0};
      return at;
    }
    if (place.x == x && place.y == y && place.z == z) return at;
    at = at + 1 < in_use_ ? at + 1 : 0;
  }
  full_ = true;
  return Spot::kNone;
}

Spot Places::add(Vec3d point_m, double mass) noexcept {
  Spot spot;
  const Vec3d p = per_m_ * point_m;
  if (per_m_ == 0 || !numbered(p.x) || !numbered(p.y) || !numbered(p.z)) return spot;
  const std::int32_t x = floor_of(p.x), y = floor_of(p.y), z = floor_of(p.z);
  const Vec3d within{p.x - x, p.y - y, p.z - z};
  // How many axes the point lies farther along: without branches, which would be guessed wrong.
  const std::size_t x_after = count(within.y > within.x, within.z > within.x);
  const std::size_t y_after = count(within.x >= within.y, within.z > within.y);
  const std::size_t z_after = 3 - x_after - y_after;
  const double least_xy = least(within.x, within.y), most_xy = most(within.x, within.y);
  const double farthest = most(most_xy, within.z), nearest = least(least_xy, within.z);
  const double between = most(least_xy, least(most_xy, within.z));
  spot.share = {1 - farthest, farthest - between, between - nearest, nearest};
  for (std::size_t i = 0; i < Spot::kCorners; ++i) {
    const double share = spot.share[i];
    if (share < kLeastShare) continue;
    spot.place[i] =
        find(x + static_cast<std::int32_t>(x_after < i), y + static_cast<std::int32_t>(y_after < i),
             z + static_cast<std::int32_t>(z_after < i));
    if (spot.place[i] == Spot::kNone) continue;
    Place& place = table_[spot.place[i]];
    place.most = most(place.most, share * mass);
    place.sum += share * mass;
  }
  return spot;
}

double Places::share(const Spot& spot, double mass) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < Spot::kCorners; ++i) {
    double brought = spot.share[i] * mass;
    if (spot.place[i] != Spot::kNone) {
      const Place& place = table_[spot.place[i]];
      if (place.most < place.sum) brought *= place.most / place.sum;
    }
    sum += brought;
  }
  return sum;
}

}  // namespace palpate::force
