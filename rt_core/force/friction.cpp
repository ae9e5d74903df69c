// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/friction.hpp"

namespace palpate::force {
namespace {

/// How the contacts of one pair press.
struct Pressure {
  double size_N = 0;
  Vec3d centre_m{};  ///< world
};

double size_of(const Contact& c, const Settings& s) noexcept {
  return c.weight * s.stiffness_N_per_m * (s.delta_m - c.distance_m);
}

Pressure pressure_of(std::uint32_t pair, std::span<const Contact> contacts,
                     const Settings& settings) noexcept {
  Pressure out;
  for (const Contact& c : contacts) {
    if (c.pair != pair) continue;
    const double n = size_of(c, settings);
    out.size_N += n;
    out.centre_m += n * c.centre_m;
  }
  if (out.size_N > 0) out.centre_m = (1 / out.size_N) * out.centre_m;
  return out;
}

/// A world point of a body's material, where it was in the last tick.
Vec3d before(const Pose& then, const Pose& now, Vec3d point_m) noexcept {
  const Vec3d in_body = transpose(rotation(now.orientation)) * (point_m - now.position_m);
  return then.position_m + rotation(then.orientation) * in_body;
}

/// The part of a stretch that the contacts' normals do not take.
Vec3d freed(Vec3d stretch_m, std::uint32_t pair, double all_N, std::span<const Contact> contacts,
            const Settings& settings) noexcept {
  Vec3d taken_m{};
  for (const Contact& c : contacts) {
    if (c.pair != pair) continue;
    taken_m += (size_of(c, settings) / all_N * dot(c.normal, stretch_m)) * c.normal;
  }
  return stretch_m - taken_m;
}

/// That of the spring: k (I - sum N_i n_i n_i^T / N) at the end of an arm.
void add_spring(std::uint32_t pair, Vec3d arm_m, double all_N, const Settings& settings,
                TickResult& result) noexcept {
  const double k = settings.stiffness_N_per_m;
  for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    result.stiffness.add_square(vec6(axis, cross(arm_m, axis)), k);
  }
  for (const Contact& c : result.contacts) {
    if (c.pair != pair) continue;
    result.stiffness.add_square(vec6(c.normal, cross(arm_m, c.normal)),
                                -k * size_of(c, settings) / all_N);
  }
}

}  // namespace

void Friction::add(std::span<const BodyPair> pairs, std::uint32_t tool_index,
                   const Settings& settings, std::span<const Pose> poses,
                   TickResult& result) noexcept {
  const double k = settings.stiffness_N_per_m;
  const Pose& tool = poses[tool_index];
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const BodyPair& pair = pairs[i];
    if (!(coefficients_[i] > 0) || (pair.a != tool_index && pair.b != tool_index)) continue;
    const Pose& other = poses[pair.a == tool_index ? pair.b : pair.a];
    Stick& stick = sticks_[i];
    const Pressure pressure = pressure_of(i, result.contacts, settings);
    if (!(pressure.size_N > 0)) {
      stick = {};
      continue;
    }
    const Mat3d axes = rotation(other.orientation);
    const Vec3d p = pressure.centre_m;
    Vec3d stretch_m{};
    if (stick.holds) {
      stretch_m =
          axes * stick.stretch_m + before(stick.other, other, p) - before(stick.tool, tool, p);
    }
    stretch_m = freed(stretch_m, i, pressure.size_N, result.contacts, settings);
    const double most_m = coefficients_[i] * pressure.size_N / k;
    const double length_m = norm(stretch_m);
    const bool slips = length_m > most_m;
    if (slips) stretch_m = (most_m / length_m) * stretch_m;

    const Vec3d arm_m = p - tool.position_m;
    const Vec3d force_N = -k * stretch_m;
    result.wrench.force_N += force_N;
    result.wrench.torque_Nm += cross(arm_m, force_N);
    if (!slips) add_spring(i, arm_m, pressure.size_N, settings, result);
    stick = {true, transpose(axes) * stretch_m, tool, other};
  }
}

}  // namespace palpate::force
