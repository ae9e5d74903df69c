// SPDX-License-Identifier: GPL-3.0-or-later
// A hip-like joint. Head and cup share the rows of the bowl, and there the cup is the head
// enlarged: triangulated alike, the two cannot touch, however few triangles they have.
#include <cmath>

#include "host_bake/models/blend.hpp"
#include "host_bake/models/noise.hpp"
#include "host_bake/models/round.hpp"
#include "host_bake/models/shapes.hpp"

namespace palpate::bake {
namespace {

constexpr double kBall_m = 0.016;
constexpr double kNeckRadius_m = 0.55 * kBall_m;
constexpr double kNeckEnd_m = 2.1 * kBall_m;  // from the ball's centre
constexpr double kNeckBlend_m = 0.2 * kBall_m;
constexpr double kJointGap = 0.0075;  // of the ball's radius
constexpr double kCupOuter_m = 1.25 * kBall_m;
constexpr double kCupRim = 100.0 / 180.0;  // polar angle of the cup's rim over half a turn
constexpr double kBowlShare = 0.55;        // of the vertices, in head and cup
constexpr double kTextureHeight = 0.006;   // of the radius
constexpr double kTextureCycles = 5.0;     // bumps a radius, of the coarsest octave
constexpr int kTextureOctaves = 3;

double texture(const Point& d, std::uint64_t seed) {
  const Point at{d[0] * kTextureCycles, d[1] * kTextureCycles, d[2] * kTextureCycles};
  return 1.0 + kTextureHeight * fractal_noise(at, kTextureOctaves, seed);
}

/// Ball, and a cylinder along +z with a rounded end, seen from the ball's centre.
double head_radius(const Point& d, std::uint64_t seed) {
  if (d[2] <= 0.0) return kBall_m * texture(d, seed);
  const double across = (square(d[0]) + square(d[1])) / square(kNeckRadius_m);
  const double along = square(d[2] / kNeckEnd_m);
  // The 8-norm of the two rounds the cylinder's edge.
  const double neck = 1.0 / std::sqrt(std::sqrt(std::sqrt(fourth(across) + fourth(along))));
  return smooth_max(kBall_m, neck, kNeckBlend_m) * texture(d, seed);
}

std::size_t bowl_vertices(std::size_t triangles) {
  const std::size_t vertices = triangles / 2;
  return static_cast<std::size_t>(kBowlShare * static_cast<double>(vertices));
}

/// From the pole to the rim.
std::vector<Row> bowl_rows(std::size_t triangles) {
  std::vector<Row> rows{{0.0, 1, 0.0}};
  append(rows, plan_rows(unit_sphere(), 0.0, kCupRim, bowl_vertices(triangles), Last::ring));
  return rows;
}

}  // namespace

Mesh ball_joint_head(std::size_t triangles, std::uint64_t seed) {
  const Surface surface = star_surface([=](const Point& d) { return head_radius(d, seed); });
  std::vector<Row> rows = bowl_rows(triangles);
  const std::size_t rest = triangles / 2 + 1 - bowl_vertices(triangles);
  append(rows, plan_rows(surface, kCupRim, 1.0, rest, Last::pole));
  return loft(surface, rows, Ends::poles);
}

Mesh ball_joint_cup(std::size_t triangles, std::uint64_t seed) {
  const Radius inner = [=](const Point& d) { return (1.0 + kJointGap) * head_radius(d, seed); };
  const Radius outer = [=](const Point& d) { return kCupOuter_m * texture(d, ~seed); };
  return cup(inner, outer, bowl_rows(triangles), triangles / 2 + 2);
}

}  // namespace palpate::bake
