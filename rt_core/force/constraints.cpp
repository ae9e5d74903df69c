// SPDX-License-Identifier: Apache-2.0
#include "rt_core/force/constraints.hpp"

namespace palpate::force {

double set_constraints(std::span<const Contact> contacts, std::span<const BodyPair> pairs,
                       std::uint32_t tool, double delta_m, std::span<PushConstraint> out) noexcept {
  constexpr double kNever = -1e300;
  double strongest = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& c = contacts[i];
    const BodyPair& pair = pairs[c.pair];
    const bool pushes = (pair.a == tool || pair.b == tool) && c.share > 0;
    const double full = c.share * (delta_m - c.distance_m);
    if (pushes && full > strongest) strongest = full;
    out[i] = {pair.a == tool ? c.normal : -c.normal, pushes ? full : kNever};
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (out[i].strength > kNever) {
      out[i].strength -= (1 - contacts[i].share) * kFadedShare * strongest;
    }
  }
  return strongest;
}

}  // namespace palpate::force
