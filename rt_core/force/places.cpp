// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/places.hpp"

namespace palpate::force {
namespace {

constexpr int kCorners = 8;
constexpr int kMostProbes = 16;  // beyond that a corner finds no room

/// Corners farther out than this have no number; the masses of contacts there are kept.
constexpr double kFarthest = 1 << 30;

std::int32_t floor_of(double v) noexcept {
  const auto towards_zero = static_cast<std::int32_t>(v);
  return v < towards_zero ? towards_zero - 1 : towards_zero;
}

bool numbered(double v) noexcept { return v > -kFarthest && v < kFarthest; }  // false for NaN

std::uint32_t hash_of(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
  std::uint64_t h = static_cast<std::uint32_t>(x) * 0x9e3779b97f4a7c15u;
  h = (h ^ static_cast<std::uint32_t>(y)) * 0xc2b2ae3d27d4eb4fu;
  h = (h ^ h >> 29 ^ static_cast<std::uint32_t>(z)) * 0x165667b19e3779f9u;
  return static_cast<std::uint32_t>(h >> 32);
}

}  // namespace

struct Places::Corners {
  std::int32_t x = 0, y = 0, z = 0;  // the lowest
  Vec3d within{};                    // of the cube, in its width

  [[nodiscard]] double share(int corner) const noexcept {
    return ((corner & 1) != 0 ? within.x : 1 - within.x) *
           ((corner & 2) != 0 ? within.y : 1 - within.y) *
           ((corner & 4) != 0 ? within.z : 1 - within.z);
  }
  [[nodiscard]] std::int32_t x_of(int corner) const noexcept { return x + (corner & 1); }
  [[nodiscard]] std::int32_t y_of(int corner) const noexcept { return y + (corner >> 1 & 1); }
  [[nodiscard]] std::int32_t z_of(int corner) const noexcept { return z + (corner >> 2); }
};

void Places::begin(double width_m) noexcept {
  per_m_ = width_m > 0 ? 1 / width_m : 0;
  full_ = false;
  if (++tick_ != 0) return;
  for (Place& place : table_) place.tick = 0;  // the count came round: old marks must not match
  tick_ = 1;
}

bool Places::corners_of(Vec3d point_m, Corners& out) const noexcept {
  const Vec3d p = per_m_ * point_m;
  if (per_m_ == 0 || !numbered(p.x) || !numbered(p.y) || !numbered(p.z)) return false;
  out.x = floor_of(p.x);
  out.y = floor_of(p.y);
  out.z = floor_of(p.z);
  out.within = {p.x - out.x, p.y - out.y, p.z - out.z};
  return true;
}

Place* Places::find(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
  auto at = static_cast<std::size_t>(
      (static_cast<std::uint64_t>(hash_of(x, y, z)) * table_.size()) >> 32);
  for (int probe = 0; probe < kMostProbes; ++probe) {
    Place& place = table_[at];
    if (place.tick != tick_) {
      place = {x, y, z, tick_, 0, 0};
      return &place;
    }
    if (place.x == x && place.y == y && place.z == z) return &place;
    at = at + 1 < table_.size() ? at + 1 : 0;
  }
  full_ = true;
  return nullptr;
}

void Places::add(Vec3d point_m, double mass) noexcept {
  Corners corners;
  if (!corners_of(point_m, corners)) return;
  for (int i = 0; i < kCorners; ++i) {
    const double brought = corners.share(i) * mass;
    if (brought == 0) continue;
    Place* place = find(corners.x_of(i), corners.y_of(i), corners.z_of(i));
    if (place == nullptr) continue;
    if (brought > place->most) place->most = brought;
    place->sum += brought;
  }
}

double Places::share(Vec3d point_m, double mass) noexcept {
  Corners corners;
  if (!corners_of(point_m, corners)) return mass;
  double sum = 0;
  for (int i = 0; i < kCorners; ++i) {
    const double brought = corners.share(i) * mass;
    if (brought == 0) continue;
    const Place* place = find(corners.x_of(i), corners.y_of(i), corners.z_of(i));
    sum += place == nullptr ? brought : brought * (place->most / place->sum);
  }
  return sum;
}

}  // namespace palpate::force
