// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/principal_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::bake {
namespace {

using Rows = std::array<std::array<double, 3>, 3>;

Rows covariance(const Moments& m) {
  const Vec3d mean = (1 / std::max(1.0, m.count)) * m.first;
  const Vec3d r0 = m.second.row0 - mean.x * m.first;
  const Vec3d r1 = m.second.row1 - mean.y * m.first;
  const Vec3d r2 = m.second.row2 - mean.z * m.first;
  return {{{r0.x, r0.y, r0.z}, {r0.y, r1.y, r1.z}, {r0.z, r1.z, r2.z}}};
}

/// One rotation that makes entry (p, q) zero; the rows of `axes` turn along.
void annihilate(Rows& a, Rows& axes, std::size_t p, std::size_t q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  const auto turn = [&](double& x, double& y) {
    const double before = x;
    x = c * before - s * y;
    y = s * before + c * y;
  };
  for (std::size_t i = 0; i < 3; ++i) turn(a[p][i], a[q][i]);
  for (std::size_t i = 0; i < 3; ++i) turn(a[i][p], a[i][q]);
  for (std::size_t i = 0; i < 3; ++i) turn(axes[p][i], axes[q][i]);
}

}  // namespace

Mat3d principal_axes(const Moments& moments) {
  constexpr int kSweeps = 12;  // converges quadratically; six are enough for doubles
  Rows a = covariance(moments);
  Rows axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    annihilate(a, axes, 0, 1);
    annihilate(a, axes, 0, 2);
    annihilate(a, axes, 1, 2);
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t k) { return a[i][i] < a[k][k]; });
  const auto row = [&](std::size_t i) {
    const auto& r = axes[order[i]];
    return Vec3d{r[0], r[1], r[2]};
  };
  return {row(0), row(1), cross(row(0), row(1))};
}

}  // namespace palpate::bake
