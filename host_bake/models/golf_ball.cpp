// SPDX-License-Identifier: GPL-3.0-or-later
// The golf ball and the shell that fits it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/noise.hpp"
#include "host_bake/models/round.hpp"
#include "host_bake/models/shapes.hpp"
#include "host_bake/models/trig.hpp"

namespace palpate::bake {
namespace {

constexpr double kRadius_m = 0.02135;  // the least that the rules of golf allow
constexpr double kDepth_m = 0.00025;
constexpr double kDimpleRadius_m = 0.00185;
constexpr std::size_t kDimples = 336;

// The rounding of the rim, as a share of the depth; it takes (1 +- kDimpleRim) of the dimple's
// radius squared.
constexpr double kDimpleRim = 0.25;

constexpr double kShellGap = 0.007;       // of the radius
constexpr double kShellOuter = 1.2;       // radii
constexpr double kShellRimTurns = 0.695;  // polar angle of the rim over half a turn, from -z

double squared_distance(const Point& a, const Point& b) {
  return square(a[0] - b[0]) + square(a[1] - b[1]) + square(a[2] - b[2]);
}

Point normalised(const Point& p) {
  const double length = std::sqrt(square(p[0]) + square(p[1]) + square(p[2]));
  return {p[0] / length, p[1] / length, p[2] / length};
}

/// One step of mutual repulsion on the unit sphere, steep so that the closest pairs give way first.
void repel(std::vector<Point>& points, double spacing) {
  constexpr double kPace = 0.02;
  constexpr double kLongestStep = 0.1;  // both in spacings
  std::vector<Point> push(points.size(), Point{});
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double d2 = squared_distance(points[i], points[j]) / square(spacing);
      if (d2 > 9.0) continue;  // beyond three spacings the force is below 1e-3 of that at one
      const double force = 1.0 / fourth(d2);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double f = force * (points[i][axis] - points[j][axis]);
        push[i][axis] += f;
        push[j][axis] -= f;
      }
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double size = std::sqrt(squared_distance(push[i], Point{}));
    const double pace = std::min(kPace, kLongestStep * spacing / std::max(size, 1e-30));
    for (std::size_t axis = 0; axis < 3; ++axis) points[i][axis] += pace * push[i][axis];
    points[i] = normalised(points[i]);
  }
}

/// Unit vectors, evenly spread: a golden-angle spiral, disturbed by the seed, then settled.
std::vector<Point> dimple_centres(std::uint64_t seed) {
  constexpr double kGoldenTurns = 0.38196601125010515;
  constexpr double kDisturbance = 0.3;
  constexpr int kSteps = 300;
  const auto count = static_cast<double>(kDimples);
  const double spacing = std::sqrt(4.0 * 3.14159265358979 / count / 0.8660254037844386);
  Random random(seed);
  std::vector<Point> points;
  for (std::size_t i = 0; i < kDimples; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / count;
    const double across = std::sqrt(1.0 - z * z);
    const double turns = kGoldenTurns * static_cast<double>(i);
    Point p{across * cos_turns(turns), across * sin_turns(turns), z};
    for (double& c : p) c += kDisturbance * spacing * random.signed_unit();
    points.push_back(normalised(p));
  }
  for (int step = 0; step < kSteps; ++step) repel(points, spacing);
  return points;
}

/// Parabolic dimples, the rim blended into the sphere.
Radius dimpled(std::uint64_t seed) {
  return [centres = dimple_centres(seed)](const Point& d) {
    double nearest = 4.0;
    for (const Point& c : centres) nearest = std::min(nearest, squared_distance(d, c));
    const double x2 = nearest / square(kDimpleRadius_m / kRadius_m);
    return kRadius_m + kDepth_m * smooth_min(x2 - 1.0, 0.0, kDimpleRim);
  };
}

std::vector<Row> ball_rows(std::size_t triangles) {
  return plan_body(unit_sphere(), 0.0, 1.0, triangles / 2 + 2);
}

}  // namespace

Mesh golf_ball(std::size_t triangles, std::uint64_t seed) {
  return loft(star_surface(dimpled(seed)), ball_rows(triangles), Ends::poles);
}

Mesh golf_shell(std::size_t triangles, std::uint64_t seed) {
  const Radius ball = dimpled(seed);
  const Radius inner = [&](const Point& d) { return (1.0 + kShellGap) * ball(d); };
  const Radius outer = [](const Point&) { return kShellOuter * kRadius_m; };
  std::vector<Row> rows = ball_rows(triangles);
  std::erase_if(rows, [](const Row& row) { return row.v > kShellRimTurns; });
  return cup(inner, outer, rows, triangles / 2 + 2);
}

}  // namespace palpate::bake
