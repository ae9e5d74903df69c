// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/scene_hand.hpp"

namespace palpate::realtime {

hal::mock::HandParameters hand_of(const config::Scene& scene) {
  const config::MockHand& from = scene.hand;
  hal::mock::HandParameters hand;
  hand.mass_kg = from.mass_kg;
  hand.inertia_kg_m2 = from.inertia_kg_m2;
  hand.grip_N_per_m = from.grip_N_per_m;
  hand.grip_Nm_per_rad = from.grip_Nm_per_rad;
  hand.damping_N_s_per_m = from.damping_N_s_per_m;
  hand.damping_Nm_s_per_rad = from.damping_Nm_s_per_rad;
  hand.rest = scene.bodies[scene.tool].pose;
  for (const config::Waypoint& w : from.path) hand.script.push_back({w.t_s, w.pose});
  return hand;
}

}  // namespace palpate::realtime
