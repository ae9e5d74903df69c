// SPDX-License-Identifier: Apache-2.0
#include "hal/mock/hand.hpp"

#include <algorithm>
#include <cmath>

#include "hal/rotation.hpp"

namespace palpate::hal::mock {
namespace {

/// Sub-steps that one step of dt_s needs; may exceed kMaxSubSteps.
double sub_steps_needed(const HandParameters& p, double dt_s) {
  const double fastest_rad_per_s =
      std::sqrt(std::max(p.grip_N_per_m / p.mass_kg, p.grip_Nm_per_rad / p.inertia_kg_m2));
  return std::max({1.0, std::ceil(dt_s / kMaxSubStep_s),
                   std::ceil(dt_s * fastest_rad_per_s / kMaxStepTimesFrequency)});
}

bool is_positive(double v) { return std::isfinite(v) && v > 0; }
bool is_not_negative(double v) { return std::isfinite(v) && v >= 0; }

/// Semi-implicit Euler of one axis triple: the new velocity, with the damper's pull taken at the
/// end of the step.
Vec3d next_velocity(Vec3d velocity, Vec3d push, double damping, Vec3d target_velocity,
                    double inertia, double h) {
  const double gain = h / inertia;
  return (1.0 / (1.0 + gain * damping)) * (velocity + gain * (push + damping * target_velocity));
}

}  // namespace

const char* why_refused(const HandParameters& p, double dt_s) noexcept {
  if (!is_positive(dt_s)) return "the device's rate must be positive";
  if (!is_positive(p.mass_kg)) return "the hand's mass must be positive";
  if (!is_positive(p.inertia_kg_m2)) return "the hand's inertia must be positive";
  if (!is_not_negative(p.grip_N_per_m) || !is_not_negative(p.grip_Nm_per_rad)) {
    return "the hand's grip must not be negative";
  }
  if (!is_not_negative(p.damping_N_s_per_m) || !is_not_negative(p.damping_Nm_s_per_rad)) {
    return "the hand's damping must not be negative";
  }
  if (!Path::is_valid(p.script)) {
    return "the script's times must ascend from 0 and its poses be finite";
  }
  if (sub_steps_needed(p, dt_s) > kMaxSubSteps) {
    return "the grip is too stiff for so small a mass or inertia";
  }
  return nullptr;
}

Hand::Hand(const HandParameters& parameters, double dt_s)
    : parameters_(parameters),
      path_(parameters.script, parameters.rest),
      sub_steps_(static_cast<int>(sub_steps_needed(parameters, dt_s))),
      step_s_(dt_s / sub_steps_),
      pose_(path_.at(0).pose) {}

double Hand::time_s() const noexcept { return static_cast<double>(steps_done_) * step_s_; }

void Hand::advance(const Wrench& wrench) noexcept {
  for (int i = 0; i < sub_steps_; ++i) {
    sub_step(wrench, path_.at(time_s()));
    ++steps_done_;
  }
}

void Hand::advance(const Wrench& wrench, const Target& target) noexcept {
  for (int i = 0; i < sub_steps_; ++i) sub_step(wrench, target);
  steps_done_ += static_cast<std::uint64_t>(sub_steps_);
}

void Hand::sub_step(const Wrench& wrench, const Target& target) noexcept {
  const HandParameters& p = parameters_;
  const double h = step_s_;

  const Vec3d pull_N = p.grip_N_per_m * (target.pose.position_m - pose_.position_m);
  Vec3d& v = twist_.linear_m_per_s;
  v = next_velocity(v, wrench.force_N + pull_N, p.damping_N_s_per_m, target.twist.linear_m_per_s,
                    p.mass_kg, h);
  pose_.position_m += h * v;

  const Vec3d twist_Nm =
      p.grip_Nm_per_rad * rotation_between(pose_.orientation, target.pose.orientation);
  Vec3d& w = twist_.angular_rad_per_s;
  w = next_velocity(w, wrench.torque_Nm + twist_Nm, p.damping_Nm_s_per_rad,
                    target.twist.angular_rad_per_s, p.inertia_kg_m2, h);
  pose_.orientation = normalised(rotation_from_vector(h * w) * pose_.orientation);
}

}  // namespace palpate::hal::mock
