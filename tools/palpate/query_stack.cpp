// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/query_stack.hpp"

#include <algorithm>
#include <cmath>

#include "tools/palpate/scene_forces.hpp"

namespace palpate::cli {
namespace {

/// An answer serves for so many periods of the server; a host's stalls are shorter.
constexpr double kMostServerPeriods = 50;
/// More than a display draws.
constexpr double kShownRate_Hz = 120;

}  // namespace

QueryStack::QueryStack(const config::Scene& scene, Engine& engine, std::span<const Pose> poses,
                       double rate_Hz, const ContactTap& tap)
    : engine_(engine, poses, scene.tool) {
  const double period_s = 1 / rate_Hz;
  if (tap.out != nullptr) {
    const double asked_Hz = scene.contact_rate_Hz.value_or(rate_Hz);
    const double every = std::max(1.0, std::round(asked_Hz / kShownRate_Hz));
    top_ = &tapped_.emplace(*top_, *tap.out, static_cast<std::uint32_t>(every), scene.settings,
                            tap.origin_m);
  }
  if (has_friction(scene)) {
    top_ =
        &friction_.emplace(*top_, scene.pairs, scene.tool, scene.settings, poses, scene.friction);
  }
  if (scene.coupling == config::Coupling::direct) {
    const realtime::SteadyRates rates{scene.steady_force_N_per_s, scene.steady_torque_Nm_per_s};
    const double contact_period_s = 1 / scene.contact_rate_Hz.value_or(rate_Hz);
    top_ = &steady_.emplace(*top_, rates, scene.settings.stiffness_N_per_m, contact_period_s);
  }
  if (scene.contact_rate_Hz) {
    const double most = std::ceil(kMostServerPeriods * rate_Hz / *scene.contact_rate_Hz);
    server_.emplace(*top_);
    top_ = &modelled_.emplace(*server_, static_cast<std::uint32_t>(most));
  }
  if (scene.coupling == config::Coupling::virtual_) {
    force::CouplingSettings settings = scene.virtual_tool;
    settings.contact_damping_s = contact_damping_s(scene);
    top_ = &coupled_.emplace(*top_, settings, period_s);
  } else if (scene.contact_damping_N_s_per_m > 0) {
    top_ = &damped_.emplace(*top_, contact_damping_s(scene), period_s);
  }
}

}  // namespace palpate::cli
