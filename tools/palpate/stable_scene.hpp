// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as a device can render it: no stiffness that it cannot hold still.
#pragma once

#include <optional>
#include <string>

#include "config/scene.hpp"

namespace palpate::cli {

struct StableScene {
  config::Scene scene;
  std::string note;  ///< what was lowered, from what to what and why; empty: nothing
};

/// Lowers the stiffness that the hand would feel to what sampling and damping allow
/// (largest_passive_stiffness, with one period from reading to command). Coupled directly that is
/// twice stiffness_N_per_m, in a gap that is tight on both sides, beside twice the contact damping;
/// coupled virtually it is the coupling's spring. The engine's own limits of force are lifted: the
/// simulated tool must not be let through, friction and linear models take the contacts as they
/// are, and the safety stage limits what is sent. Translation only; the coupling's damper is not
/// counted, which matters for hands without mass only.
/// @param damping_N_s_per_m  of the device and the hand that holds it; unknown: nothing is lowered
[[nodiscard]] StableScene stable_scene(config::Scene scene, double rate_Hz,
                                       std::optional<double> damping_N_s_per_m);

}  // namespace palpate::cli
