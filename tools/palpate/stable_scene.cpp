// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/stable_scene.hpp"

#include <limits>
#include <utility>

#include "config/scene_keys.hpp"
#include "tools/realtime/passivity.hpp"

namespace palpate::cli {
namespace {

/// Normals on both sides count apart (rt_core/force/wrench.hpp).
constexpr double kSidesOfAGap = 2;

std::string lowered(const std::string& key, double& value, double most, double rate_Hz,
                    double damping_N_s_per_m) {
  if (value <= most) return {};
  const std::string from = config::to_text(value);
  value = most;
  return key + " lowered from " + from + " to " + config::to_text(most) +
         ": more is not stable at " + config::to_text(rate_Hz) + " Hz with a damping of " +
         config::to_text(damping_N_s_per_m) +
         " N s/m; raise rate_Hz or, if the device has more, device_damping_N_s_per_m";
}

}  // namespace

StableScene stable_scene(config::Scene scene, double rate_Hz,
                         std::optional<double> damping_N_s_per_m) {
  StableScene out{std::move(scene), {}};
  const bool direct = out.scene.coupling == config::Coupling::direct;
  Settings& settings = out.scene.settings;
  settings.max_force_N = settings.max_torque_Nm = std::numeric_limits<double>::infinity();
  if (!damping_N_s_per_m) return out;
  const double period_s = 1 / rate_Hz;
  const double rendered = direct ? kSidesOfAGap * out.scene.contact_damping_N_s_per_m : 0;
  const double most =
      realtime::largest_passive_stiffness(*damping_N_s_per_m, rendered, period_s, period_s);
  out.note = direct ? lowered("stiffness_N_per_m", settings.stiffness_N_per_m, most / kSidesOfAGap,
                              rate_Hz, *damping_N_s_per_m)
                    : lowered("spring_N_per_m", out.scene.virtual_tool.spring_N_per_m, most,
                              rate_Hz, *damping_N_s_per_m);
  return out;
}

}  // namespace palpate::cli
