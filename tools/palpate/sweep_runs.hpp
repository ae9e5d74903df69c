// SPDX-License-Identifier: GPL-3.0-or-later
// The replays of a sweep (docs/SWEEP.md, "How it runs").
#pragma once

#include <cstddef>
#include <span>

#include "config/scene.hpp"
#include "host_bake/base/error.hpp"
#include "tools/palpate/poses.hpp"
#include "tools/palpate/sweep_folder.hpp"
#include "tools/palpate/sweep_settings.hpp"

namespace palpate::cli {

struct SweepRuns {
  std::size_t timed_ticks = 2000;  ///< >= 1
  unsigned repeat = 1;             ///< >= 1
  unsigned threads = 0;            ///< 0: all cores
  bool processor_time = false;     ///< see ReplayOptions
};

/// Replays every setting that the folder does not have, and saves it as soon as it is done. Gives
/// the number of settings that computed something else the second time. Throws what replay() and
/// SweepFolder throw; what was done until then is kept.
[[nodiscard]] std::size_t run_settings(const SweepFolder& folder, const config::Scene& scene,
                                       const PoseTrack& track,
                                       std::span<const SweepSetting> settings,
                                       const SweepRuns& runs, const bake::Progress& progress);

}  // namespace palpate::cli
