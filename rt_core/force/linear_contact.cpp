// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/linear_contact.hpp"

#include "rt_core/force/displacement.hpp"

namespace palpate::force {

Wrench predicted(const LinearContact& contact, const Pose& tool) noexcept {
  const Vec6 fall = contact.stiffness * displacement(contact.tool, tool);
  return {contact.wrench.force_N - linear(fall), contact.wrench.torque_Nm - angular(fall)};
}

Wrench damped(const Wrench& wrench, const Matrix6& stiffness, const Vec6& velocity,
              double damping_s) noexcept {
  const Vec6 resisted = stiffness * velocity;
  const Vec3d force_N = damping_s * linear(resisted);
  const double most_N = norm(wrench.force_N);
  const double length_N = norm(force_N);
  const double share = length_N > most_N ? most_N / length_N : 1;
  return {wrench.force_N - share * force_N,
          wrench.torque_Nm - (share * damping_s) * angular(resisted)};
}

}  // namespace palpate::force
