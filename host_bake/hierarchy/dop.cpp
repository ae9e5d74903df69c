// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/hierarchy/dop.hpp"

#include <algorithm>
#include <limits>

#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {
namespace {

constexpr double kHalf = 0.70710678118654752;   // 1 / sqrt 2
constexpr double kThird = 0.57735026918962576;  // 1 / sqrt 3
constexpr std::array<std::array<double, 3>, kDopDirections> kDirections{{
    {1, 0, 0},
    {0, 1, 0},
    {0, 0, 1},
    {kHalf, kHalf, 0},
    {kHalf, -kHalf, 0},
    {kHalf, 0, kHalf},
    {kHalf, 0, -kHalf},
    {0, kHalf, kHalf},
    {0, kHalf, -kHalf},
    {kThird, kThird, kThird},
    {kThird, kThird, -kThird},
    {kThird, -kThird, kThird},
    {kThird, -kThird, -kThird},
}};

}  // namespace

Dop dop_of(std::span<const PointF> points) {
  Dop dop;
  dop.low.fill(std::numeric_limits<double>::infinity());
  dop.high.fill(-std::numeric_limits<double>::infinity());
  for (const PointF& p : points) {
    const auto [x, y, z] = vec_cast<double>(Vec3f{p[0], p[1], p[2]});
    for (std::size_t i = 0; i < kDopDirections; ++i) {
      const double v = kDirections[i][0] * x + kDirections[i][1] * y + kDirections[i][2] * z;
      dop.low[i] = std::min(dop.low[i], v);
      dop.high[i] = std::max(dop.high[i], v);
    }
  }
  return dop;
}

Dop united(const Dop& a, const Dop& b) {
  Dop dop;
  for (std::size_t i = 0; i < kDopDirections; ++i) {
    dop.low[i] = std::min(a.low[i], b.low[i]);
    dop.high[i] = std::max(a.high[i], b.high[i]);
  }
  return dop;
}

double mean_width(const Dop& dop) {
  double sum = 0;
  for (std::size_t i = 0; i < kDopDirections; ++i) sum += dop.high[i] - dop.low[i];
  return sum / kDopDirections;
}

}  // namespace palpate::bake
