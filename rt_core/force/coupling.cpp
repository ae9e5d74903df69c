// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/coupling.hpp"

#include "rt_core/force/displacement.hpp"

namespace palpate::force {
namespace {

Quat turned(const Quat& q, Vec3d angle_rad) noexcept {
  const Quat d = Quat{0, 0.5 * angle_rad.x, 0.5 * angle_rad.y, 0.5 * angle_rad.z} * q;
  const Quat sum{q.w + d.w, q.x + d.x, q.y + d.y, q.z + d.z};
  const double length = sqrt_of(sum.w * sum.w + sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  return {sum.w / length, sum.x / length, sum.y / length, sum.z / length};
}

}  // namespace

VirtualTool::VirtualTool(const CouplingSettings& s) noexcept
    : settings_(s),
      damper_N_s_per_m_(2 * sqrt_of(s.spring_N_per_m * s.mass_kg)),
      damper_Nm_s_per_rad_(2 * sqrt_of(s.spring_Nm_per_rad * s.inertia_kg_m2)) {}

void VirtualTool::reset(const Pose& at) noexcept {
  pose_ = handle_before_ = at;
  velocity_ = {};
}

Wrench VirtualTool::step(const Pose& handle, const Wrench& contact, const Matrix6& stiffness,
                         double period_s) noexcept {
  const CouplingSettings& s = settings_;
  const Vec6 behind = displacement(pose_, handle);
  const Vec6 moved = displacement(handle_before_, handle);
  handle_before_ = handle;

  const double t = period_s;
  Matrix6 m;
  m.add(stiffness, t * (t + s.contact_damping_s));
  m.add_diagonal(s.mass_kg + t * damper_N_s_per_m_ + t * t * s.spring_N_per_m,
                 s.inertia_kg_m2 + t * damper_Nm_s_per_rad_ + t * t * s.spring_Nm_per_rad);
  Vec6 momentum = vec6(t * contact.force_N, t * contact.torque_Nm);
  for (std::size_t i = 0; i < momentum.size(); ++i) {
    const bool is_linear = i < 3;
    momentum[i] += (is_linear ? s.mass_kg : s.inertia_kg_m2) * velocity_[i] +
                   t * (is_linear ? s.spring_N_per_m : s.spring_Nm_per_rad) * behind[i] +
                   (is_linear ? damper_N_s_per_m_ : damper_Nm_s_per_rad_) * moved[i];
  }
  velocity_ = m.solve(momentum);
  pose_.position_m += t * linear(velocity_);
  pose_.orientation = turned(pose_.orientation, t * angular(velocity_));

  const Vec6 ahead = displacement(handle, pose_);
  const Vec3d slip_m_per_s = linear(velocity_) - (1 / t) * linear(moved);
  const Vec3d slip_rad_per_s = angular(velocity_) - (1 / t) * angular(moved);
  return {s.spring_N_per_m * linear(ahead) + damper_N_s_per_m_ * slip_m_per_s,
          s.spring_Nm_per_rad * angular(ahead) + damper_Nm_s_per_rad_ * slip_rad_per_s};
}

}  // namespace palpate::force
