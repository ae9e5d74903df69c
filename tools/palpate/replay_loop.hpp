// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a scene's engine over recorded poses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "rt_core/counters.hpp"
#include "tools/palpate/poses.hpp"
#include "tools/palpate/replay_csv.hpp"

namespace palpate::cli {

struct ReplayOptions {
  std::optional<std::uint64_t> budget_units;  ///< beside the scene's budget_us; absent: unlimited
  std::uint64_t reserve_units = 0;            ///< beyond them (Budget::reserve_units)
  unsigned repeat = 1;                        ///< >= 1
  /// Times and budgets in processor time of the thread, which does not count when others have the
  /// processor; else in real time.
  bool processor_time = false;
  bool profile = false;  ///< give the engine a clock, for its stages' times
};

/// What a replay tells while it runs; each may be empty.
struct ReplayListeners {
  std::function<void(double done)> progress;
  /// The contacts of each tick of the last repetition, in order, with points on the surfaces
  /// (SurfacePoints); called between ticks.
  std::function<void(std::size_t tick, std::span<const Contact>)> contacts;
};

/// What the last repetition gave; times are the median over all repetitions, tick by tick.
struct Recording {
  std::vector<TickRow> ticks;
  std::string start_overlap;  ///< overlap_line() of the first tick
  std::size_t image_bytes = 0;
  std::size_t engine_bytes = 0;
  Limits limits;                     ///< the scene's, or what it took
  std::optional<Counters> counters;  ///< absent where the engine counts nothing
};

/// Replays the track options.repeat times, each with a new engine, so that all repetitions do the
/// same work. Only the engine's tick lies between the two readings of the clock: nothing is
/// formatted or written there. The scene's friction and damping (SceneForces) are in the wrench.
///
/// Where neither time nor units are limited the answer shall not be cut for want of memory either:
/// a tick that runs out of it is done again by an engine with twice the room, up to the scene's
/// max_memory_MB. Throws Failure as SceneEngine does, kOther where a tick fails, and what the
/// listeners throw.
Recording replay(const config::Scene& scene, const PoseTrack& track, const ReplayOptions& options,
                 const ReplayListeners& listeners);

}  // namespace palpate::cli
