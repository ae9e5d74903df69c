// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of a sweep: docs/SWEEP.md.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "config/scene.hpp"

namespace palpate::cli {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// What one replay of a sweep sets; all else is the scene's.
struct SweepSetting {
  EngineKind engine = EngineKind::levels;
  bool exact = false;
  double s0 = 0;                  ///< levels, not exact
  double kappa = kNoLimit;        ///< levels, not exact; infinity: no such rule
  double force_tolerance_N = 0;   ///< regions, not exact
  double budget_us = kNoLimit;    ///< infinity: none; exact: none
  Bounds bounds = Bounds::tight;  ///< levels
  double delta_m = 0;

  bool operator==(const SweepSetting&) const = default;
};

/// Values of each axis, in the units of SweepSetting.
struct SweepAxes {
  std::vector<EngineKind> engines;
  std::vector<double> s0, kappa, force_tolerance_N, budget_us, delta_m;
  std::vector<Bounds> bounds;
};

/// All combinations, each once; for each delta the exact ones first: levels with tight bounds, with
/// the paper's, regions, as far as the engines are asked for. Of two settings that differ where
/// their engine does not look, one.
std::vector<SweepSetting> expand(const SweepAxes& axes);

/// A name without spaces, one for each setting, fit for a file: "levels-s0_0.025-kappa_0.1-...".
std::string id_of(const SweepSetting& setting);

/// The exact setting that this one is measured against: same engine, same delta, tight bounds.
SweepSetting reference_of(const SweepSetting& setting);

/// The scene at this setting.
config::Scene with_setting(const config::Scene& scene, const SweepSetting& setting);

}  // namespace palpate::cli
