// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene adds to the contact force, friction and damping, over recorded poses.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "config/scene.hpp"
#include "rt_core/force/friction.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::cli {

[[nodiscard]] bool has_friction(const config::Scene& scene);

/// Damping of the contacts over their stiffness; 0: none.
[[nodiscard]] double contact_damping_s(const config::Scene& scene);

/// As QueryStack has them in the loop, but every body may move, and a velocity is what lies between
/// the poses of successive ticks. Damping resists the tool's own velocity, whatever the others do.
class SceneForces {
 public:
  explicit SceneForces(const config::Scene& scene);
  // Friction refers to the members beside it.
  SceneForces(const SceneForces&) = delete;
  SceneForces& operator=(const SceneForces&) = delete;
  SceneForces(SceneForces&&) = delete;
  SceneForces& operator=(SceneForces&&) = delete;
  ~SceneForces() = default;

  /// The scene for the engine: without limits of force and torque where something is added behind
  /// it, which are then applied here.
  [[nodiscard]] config::Scene for_engine() const;

  /// Nothing touches and nothing has moved yet.
  void restart();

  /// Adds to a tick's answer. @param t_s  later than that of the tick before
  /// @param poses  [bodies] that it was asked for; unit quaternions
  void add(double t_s, std::span<const Pose> poses, TickResult& result);

 private:
  struct Before {
    double t_s = 0;
    Pose tool;
  };
  [[nodiscard]] bool any() const { return has_friction_ || damping_s_ > 0; }

  const config::Scene& scene_;
  bool has_friction_;
  double damping_s_;
  std::vector<force::Stick> sticks_;
  force::Friction friction_;
  std::optional<Before> before_;
};

}  // namespace palpate::cli
