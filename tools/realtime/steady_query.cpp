// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/steady_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/force/displacement.hpp"

namespace palpate::realtime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What is left of a difference after coming nearer by a step.
Vec3d less(const Vec3d& difference, double step) {
  const double length = norm(difference);
  return length > step ? (1 - step / length) * difference : Vec3d{};
}

/// 0 where one of the rates is infinite, and nothing is held back anyway.
double arm_m(const SteadyRates& rates) {
  const double ratio = rates.torque_Nm_per_s / rates.force_N_per_s;
  return std::isfinite(ratio) ? ratio : 0;
}

/// Of all directions together.
double linear_part(const Matrix6& stiffness) {
  return stiffness.at(0, 0) + stiffness.at(1, 1) + stiffness.at(2, 2);
}

}  // namespace

SteadyQuery::SteadyQuery(ContactQuery& contacts, const SteadyRates& rates, double stiffness_N_per_m,
                         double period_s) noexcept
    : contacts_(contacts),
      most_N_(rates.force_N_per_s * period_s),
      most_Nm_(rates.torque_Nm_per_s * period_s),
      arm_m_(arm_m(rates)),
      stiffness_N_per_m_(stiffness_N_per_m) {}

Wrench SteadyQuery::believed(const TickResult& found, const Vec6& way, const Vec6& fall) noexcept {
  const double motion_m = norm(linear(way)) + arm_m_ * norm(angular(way));
  const double slope_N = kSlope * linear_part(before_.stiffness) * motion_m;
  const double doubt_N = kDoubt * stiffness_N_per_m_ * found.certificate.error_bound_m;
  const double doubts_N = before_doubt_N_ + doubt_N;
  before_doubt_N_ = doubt_N;
  const bool apart = found.contacts.empty();
  const bool deep = found.certificate.truncated() && found.min_distance_m < 0;
  const auto follow = [&](Doubtful& part, const Vec3d& told, const Vec3d& modelled, double arm,
                          double most) {
    // Where no contact is found, no more is felt than the doubt leaves possible.
    const double changed = norm(apart ? part.believed() : told - part.told());
    const double of_motion = arm * stiffness_N_per_m_ * motion_m;
    double beyond_doubt = changed - arm * doubts_N;
    if (deep) beyond_doubt = std::min(beyond_doubt, kDeepShare * of_motion);
    double certain = std::max({beyond_doubt, norm(modelled) - arm * slope_N, 0.0});
    if (!begun_) certain = kInfinity;
    return part.follow(told, {certain, of_motion, kLeastShare * most});
  };
  const Wrench out{follow(force_N_, found.wrench.force_N, linear(fall), 1, most_N_),
                   follow(torque_Nm_, found.wrench.torque_Nm, angular(fall), arm_m_, most_Nm_)};
  begun_ = true;
  return out;
}

Status SteadyQuery::tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept {
  const Status status = contacts_.tick(tool, budget, out);
  if (status != Status::ok) return status;
  const Vec6 way = force::displacement(before_.tool, tool);
  const Vec6 fall = before_.stiffness * way;
  const Wrench told = out.wrench;
  const Wrench aim = believed(out, way, fall);
  const Wrench expected{before_.wrench.force_N - linear(fall),
                        before_.wrench.torque_Nm - angular(fall)};
  out.wrench.force_N = aim.force_N + less(expected.force_N - aim.force_N, most_N_);
  out.wrench.torque_Nm = aim.torque_Nm + less(expected.torque_Nm - aim.torque_Nm, most_Nm_);
  off_ = {out.wrench.force_N - told.force_N, out.wrench.torque_Nm - told.torque_Nm};
  out.certificate.force_bound_N += norm(off_.force_N);
  before_ = {tool, out.wrench, out.stiffness};
  return status;
}

}  // namespace palpate::realtime
