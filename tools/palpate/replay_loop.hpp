// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a scene's engine over recorded poses.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "config/scene.hpp"
#include "tools/palpate/poses.hpp"
#include "tools/palpate/replay_csv.hpp"

namespace palpate::cli {

struct ReplayOptions {
  std::optional<std::uint64_t> budget_units;  ///< beside the scene's budget_us; absent: unlimited
  unsigned repeat = 1;                        ///< >= 1
  bool keep_contacts = false;
};

/// What the last repetition gave; times are the median over all repetitions, tick by tick.
struct Recording {
  std::vector<TickRow> ticks;
  std::vector<ContactRow> contacts;  ///< empty unless kept
  std::size_t image_bytes = 0;
  std::size_t engine_bytes = 0;
};

/// Replays the track options.repeat times, each with a new engine, so that all repetitions do the
/// same work. Only the engine's tick lies between the two readings of the clock: nothing is
/// formatted or written in the loop.
/// @param show  called now and then with the share done
/// Throws Failure as SceneEngine does, and kOther where a tick fails.
Recording replay(const config::Scene& scene, const PoseTrack& track, const ReplayOptions& options,
                 const std::function<void(double done)>& show);

}  // namespace palpate::cli
