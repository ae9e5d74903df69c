// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/scene_forces.hpp"

#include <algorithm>
#include <limits>

#include "rt_core/force/displacement.hpp"
#include "rt_core/force/linear_contact.hpp"
#include "rt_core/force/wrench.hpp"

namespace palpate::cli {

bool has_friction(const config::Scene& scene) {
  return std::any_of(scene.friction.begin(), scene.friction.end(), [](double f) { return f > 0; });
}

double contact_damping_s(const config::Scene& scene) {
  const double stiffness = scene.settings.stiffness_N_per_m;
  return stiffness > 0 ? scene.contact_damping_N_s_per_m / stiffness : 0;
}

SceneForces::SceneForces(const config::Scene& scene)
    : scene_(scene),
      has_friction_(has_friction(scene)),
      damping_s_(contact_damping_s(scene)),
      sticks_(scene.pairs.size()),
      friction_(scene.friction, sticks_) {}

config::Scene SceneForces::for_engine() const {
  config::Scene scene = scene_;
  if (any()) {
    scene.settings.max_force_N = scene.settings.max_torque_Nm =
        std::numeric_limits<double>::infinity();
  }
  return scene;
}

void SceneForces::restart() {
  std::fill(sticks_.begin(), sticks_.end(), force::Stick{});
  before_.reset();
}

void SceneForces::add(double t_s, std::span<const Pose> poses, TickResult& result) {
  if (!any()) return;
  const Pose& tool = poses[scene_.tool];
  if (has_friction_) friction_.add(scene_.pairs, scene_.tool, scene_.settings, poses, result);
  if (before_) {
    Vec6 velocity = force::displacement(before_->tool, tool);
    for (double& v : velocity) v /= t_s - before_->t_s;
    result.wrench = force::damped(result.wrench, result.stiffness, velocity, damping_s_);
  }
  before_ = {t_s, tool};
  result.wrench = force::limited(result.wrench, scene_.settings);
}

}  // namespace palpate::cli
