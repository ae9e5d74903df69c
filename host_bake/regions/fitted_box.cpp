// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/fitted_box.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "host_bake/metrics/vector.hpp"
#include "host_bake/regions/principal_axes.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kSample = 256;
// Twelve steps of 7.5 degrees make a quarter turn. Constants, for libm differs between hosts.
constexpr int kTurns = 12;
constexpr double kCosine = 0.99144486137381041;
constexpr double kSine = 0.13052619222005159;
// The tangent of half the angle that a box is turned by at first: six degrees.
constexpr double kFirstTurn = 0.05;
constexpr int kRounds = 16;

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

double surface(const Mat3d& axes, std::span<const Vec3d> points) {
  Interval along[3];
  for (const Vec3d& p : points) {
    along[0].add(dot(axes.row0, p));
    along[1].add(dot(axes.row1, p));
    along[2].add(dot(axes.row2, p));
  }
  const double a = along[0].high - along[0].low;
  const double b = along[1].high - along[1].low;
  const double c = along[2].high - along[2].low;
  return a * b + b * c + c * a;
}

std::vector<Vec3d> sample_of(std::span<const Vec3d> points) {
  const std::size_t step = (points.size() + kSample - 1) / kSample;
  std::vector<Vec3d> sample;
  for (std::size_t i = 0; i < points.size(); i += step) sample.push_back(points[i]);
  return sample;
}

class Search {
 public:
  explicit Search(std::span<const Vec3d> points) : sample_(sample_of(points)) {}

  void consider(const Mat3d& axes) {
    const double s = surface(axes, sample_);
    if (s < least_) {
      least_ = s;
      best_ = axes;
    }
  }
  void consider_turned(Vec3d n, Vec3d start) {
    Vec3d u = start;
    for (int i = 0; i < kTurns; ++i) {
      consider({u, cross(n, u), n});
      u = unit(kCosine * u + kSine * cross(n, u));
    }
  }
  /// The best one, about its own axes.
  void consider_turned_a_little() {
    double tangent = kFirstTurn;
    for (int round = 0; round < kRounds; ++round) {
      const double before = least_;
      const Vec3d rows[3] = {best_.row0, best_.row1, best_.row2};
      for (std::size_t k = 0; k < 3; ++k) {
        consider(turned(rows, k, tangent));
        consider(turned(rows, k, -tangent));
      }
      if (!(least_ < before)) tangent *= 0.5;
    }
  }
  [[nodiscard]] const Mat3d& best() const { return best_; }

 private:
  /// @param tangent  of half the angle, from which sine and cosine follow without libm
  static Mat3d turned(const Vec3d (&rows)[3], std::size_t about, double tangent) {
    const double all = 1 + tangent * tangent;
    const double cosine = (1 - tangent * tangent) / all;
    const double sine = 2 * tangent / all;
    const std::size_t u = (about + 1) % 3;
    const std::size_t v = (about + 2) % 3;
    Vec3d out[3];
    out[about] = rows[about];
    out[u] = cosine * rows[u] + sine * rows[v];
    out[v] = cosine * rows[v] - sine * rows[u];
    return {out[0], out[1], out[2]};
  }

  std::vector<Vec3d> sample_;
  Mat3d best_;
  double least_ = std::numeric_limits<double>::infinity();
};

std::array<float, 3> rounded(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Rounded up, with room for the rounding of the double that is given.
float above(double v) {
  constexpr double kRoom = 1e-14;  // coordinates are at most 1: some 1e-16 a product
  return std::nextafter(static_cast<float>(v + kRoom), std::numeric_limits<float>::infinity());
}

FittedBox box_along(const Mat3d& axes, std::span<const Vec3d> points) {
  FittedBox box;
  const Vec3d exact[3] = {axes.row0, axes.row1, axes.row2};
  Vec3d middle{};
  for (std::size_t k = 0; k < 3; ++k) {
    box.axes[k] = rounded(exact[k]);
    Interval along;
    for (const Vec3d& p : points) along.add(dot(exact[k], p));
    middle += (0.5 * (along.low + along.high)) * exact[k];
  }
  box.centre = rounded(middle);
  for (std::size_t k = 0; k < 3; ++k) {
    double reach = 0;
    for (const Vec3d& p : points) {
      reach = std::max(reach, std::abs(dot(vec(box.axes[k]), p - vec(box.centre))));
    }
    box.half[k] = above(reach);
  }
  return box;
}

}  // namespace

FittedBox fit_box(std::span<const Vec3d> points, Vec3d normal, std::span<const Vec3d> edges) {
  Moments moments;
  for (const Vec3d& p : points) moments.add(p);
  const Mat3d principal = principal_axes(moments);
  Search search(points);
  search.consider(principal);
  const Vec3d n = unit(normal);
  if (squared_norm(n) > 0) {
    for (const Vec3d& edge : edges) {
      const Vec3d u = unit(edge - dot(edge, n) * n);
      if (squared_norm(u) > 0) search.consider({u, cross(n, u), n});
    }
    if (edges.empty()) search.consider_turned(n, across(n));
  }
  if (edges.empty()) {
    search.consider_turned(principal.row0, principal.row1);
    search.consider_turned_a_little();
  }
  return box_along(search.best(), points);
}

}  // namespace palpate::bake
