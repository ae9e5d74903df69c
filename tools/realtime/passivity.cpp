// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/passivity.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::realtime {

double largest_passive_stiffness(double damping, double virtual_damping, double period_s,
                                 double delay_s) noexcept {
  return std::max(0.0, damping - std::abs(virtual_damping)) / (0.5 * period_s + delay_s);
}

void PassivityController::observe(const Wrench& in_force, Vec3d moved_m, Vec3d turned_rad,
                                  double elapsed_s) noexcept {
  const double work_J = -(dot(in_force.force_N, moved_m) + dot(in_force.torque_Nm, turned_rad));
  // A reading that is not a number is the safety stage's business; it must not spoil the sum.
  if (!std::isfinite(work_J) || !(elapsed_s > 0)) {
    velocity_ = {};
    return;
  }
  energy_J_ += work_J;
  energy_J_min_ = std::min(energy_J_min_, energy_J_);
  velocity_ = {(1 / elapsed_s) * moved_m, (1 / elapsed_s) * turned_rad};
}

Wrench PassivityController::control(const Wrench& rendered, double period_s) const noexcept {
  if (energy_J_ >= 0) return rendered;
  // One share of both largest dampers: they take this much energy a period at most.
  const double most_W = limits_.damper_N_s_per_m * squared_norm(velocity_.linear_m_per_s) +
                        limits_.damper_Nm_s_per_rad * squared_norm(velocity_.angular_rad_per_s);
  if (!(most_W > 0)) return rendered;
  const double share = std::min(1.0, -energy_J_ / (period_s * most_W));
  return {rendered.force_N - (share * limits_.damper_N_s_per_m) * velocity_.linear_m_per_s,
          rendered.torque_Nm - (share * limits_.damper_Nm_s_per_rad) * velocity_.angular_rad_per_s};
}

}  // namespace palpate::realtime
