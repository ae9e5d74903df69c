// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/wrench.hpp"

namespace palpate::force {
namespace {

/// Sums that are this small a share of their parts are rounding.
constexpr double kCancelled = 1e-12;
/// As in the least push: coincident normals stay solvable.
constexpr double kRidge = 1e-9;

void weigh(std::span<const PushConstraint> constraints, const Push& push,
           std::span<PushPoint> points, const Pose& tool, const Settings& settings,
           Places& places) noexcept {
  const Mat3d to_tool = transpose(rotation(tool.orientation));
  // In units of delta: squares of lengths in metres may leave the range of double.
  const double per_delta = 1 / settings.delta_m;
  std::uint32_t taking_part = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double strength = constraints[i].strength;
    const double pushed = push.along(constraints[i].normal);
    const double above = per_delta * (strength - (pushed > 0 ? kTakesPart * pushed : 0));
    points[i].mass = strength > 0 && above > 0 ? above * above : 0;
    taking_part += points[i].mass > 0 ? 1u : 0u;
  }
  places.begin(settings.cluster_radius_m, taking_part);
  for (PushPoint& p : points) {
    if (p.mass > 0) p.spot = places.add(to_tool * p.arm_m, p.mass);
  }
  for (PushPoint& p : points) {
    if (p.mass > 0) p.mass = places.share(p.spot, p.mass);
  }
}

Vec3d limited(Vec3d v, double most) noexcept {
  const double length = norm(v);
  return length > most ? (most / length) * v : v;
}

/// Where pushes along n act.
Vec3d arm_of(Vec3d n, Vec3d otherwise, std::span<const PushConstraint> constraints,
             std::span<const PushPoint> points) noexcept {
  Vec3d sum{};
  double all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].mass > 0)) continue;
    const double c = dot(n, constraints[i].normal);
    if (!(c > 0)) continue;
    const double mass = kinship(c) * points[i].mass;
    sum += mass * points[i].arm_m;
    all += mass;
  }
  return all > 0 ? (1 / all) * sum : otherwise;
}

/// Adds 2 k J^T G^-1 J.
/// @param rows  of J; made orthonormal in the metric of G, by Cholesky
void add_stiffness(Vec6 (&rows)[kMostCarrying], const Vec3d (&normals)[kMostCarrying],
                   std::uint32_t count, double twice_k, Matrix6& out) noexcept {
  double factor[kMostCarrying][kMostCarrying] = {};
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = 0; j <= i; ++j) {
      const double c = dot(normals[i], normals[j]);
      double q = c + c * c + (i == j ? kRidge : 0);
      for (std::uint32_t k = 0; k < j; ++k) q -= factor[i][k] * factor[j][k];
      factor[i][j] = i == j ? sqrt_of(q > kRidge ? q : kRidge) : q / factor[j][j];
    }
    for (std::uint32_t k = 0; k < i; ++k) {
      for (std::size_t e = 0; e < rows[i].size(); ++e) rows[i][e] -= factor[i][k] * rows[k][e];
    }
    for (double& e : rows[i]) e /= factor[i][i];
    out.add_square(rows[i], twice_k);
  }
}

}  // namespace

PushWrench push_wrench(std::span<const PushConstraint> constraints, const PushResult& push,
                       std::span<PushPoint> points, const Pose& tool, const Settings& settings,
                       Places& places) noexcept {
  PushWrench out;
  if (push.carrying_count == 0) return out;
  weigh(constraints, push.push, points, tool, settings, places);
  out.places_full = places.full();
  const double twice_k = 2 * settings.stiffness_N_per_m;
  Vec6 rows[kMostCarrying] = {};
  Vec3d normals[kMostCarrying];
  double all_N = 0;
  double farthest2 = 0;
  for (std::uint32_t i = 0; i < push.carrying_count; ++i) {
    const Carrying& c = push.carrying[i];
    const Vec3d n = normals[i] = constraints[c.index].normal;
    const Vec3d arm_m = arm_of(n, points[c.index].arm_m, constraints, points);
    const Vec3d force_N = (twice_k * c.multiplier) * n;
    const Vec3d turn = cross(arm_m, n);
    rows[i] = vec6(n, turn);
    all_N += twice_k * c.multiplier;
    const double arm2 = squared_norm(arm_m);
    farthest2 = arm2 > farthest2 ? arm2 : farthest2;
    out.wrench.force_N += force_N;
    out.wrench.torque_Nm += cross(arm_m, force_N);
  }
  if (norm(out.wrench.force_N) <= kCancelled * all_N) out.wrench.force_N = {};
  if (norm(out.wrench.torque_Nm) <= kCancelled * all_N * sqrt_of(farthest2)) {
    out.wrench.torque_Nm = {};
  }
  add_stiffness(rows, normals, push.carrying_count, twice_k, out.stiffness);
  return out;
}

Wrench limited(const Wrench& wrench, const Settings& settings) noexcept {
  return {limited(wrench.force_N, settings.max_force_N),
          limited(wrench.torque_Nm, settings.max_torque_Nm)};
}

}  // namespace palpate::force
