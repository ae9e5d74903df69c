// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_runs.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "host_bake/base/parallel.hpp"
#include "tools/palpate/replay_loop.hpp"

namespace palpate::cli {
namespace {

/// All that a tick computes but its time.
bool same_answer(const TickRow& a, const TickRow& b) {
  const bool same_distance = a.min_distance_m == b.min_distance_m ||
                             (std::isnan(a.min_distance_m) && std::isnan(b.min_distance_m));
  return same_distance && a.wrench.force_N == b.wrench.force_N &&
         a.wrench.torque_Nm == b.wrench.torque_Nm && a.contacts == b.contacts &&
         a.front_nodes == b.front_nodes && a.queries == b.queries &&
         a.certificate.error_bound_m == b.certificate.error_bound_m;
}

bool timed(const std::vector<TickRow>& ticks) { return ticks.front().time_ns > 0; }

class Runs {
 public:
  Runs(const SweepFolder& folder, const config::Scene& scene, const PoseTrack& track,
       const SweepRuns& runs, const bake::Progress& progress)
      : folder_(folder),
        scene_(scene),
        track_(track),
        first_(track),
        runs_(runs),
        progress_(progress) {
    first_.ticks.resize(std::min(runs.timed_ticks, track.ticks.size()));
  }

  /// Ticks without times, all cores.
  void answer(std::span<const SweepSetting> settings) const {
    std::vector<SweepSetting> open;
    for (const SweepSetting& s : settings) {
      if (std::isinf(s.budget_us) && !folder_.load(s)) open.push_back(s);
    }
    std::mutex one_at_a_time;
    std::size_t done = 0;
    const auto threads =
        runs_.threads > 0 ? runs_.threads : unsigned(tbb::info::default_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    bake::parallel_for(open.size(), [&](std::size_t i) {
      std::vector<TickRow> ticks = replay(with_setting(scene_, open[i]), track_, {}, {}).ticks;
      for (TickRow& tick : ticks) tick.time_ns = 0;
      folder_.save(open[i], ticks);
      const std::scoped_lock lock(one_at_a_time);
      progress_("answers", double(++done) / double(open.size()));
    });
  }

  /// Times, one setting after another.
  [[nodiscard]] std::size_t time(std::span<const SweepSetting> settings) const {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const auto known = folder_.load(settings[i]);
      if ((!known || !timed(*known)) && !time(settings[i], known)) ++differing;
      progress_("times", double(i + 1) / double(settings.size()));
    }
    return differing;
  }

  [[nodiscard]] bool whole_track_is_timed() const {
    return first_.ticks.size() == track_.ticks.size();
  }

 private:
  /// Whether what is known already was computed again.
  [[nodiscard]] bool time(const SweepSetting& setting,
                          const std::optional<std::vector<TickRow>>& known) const {
    const bool whole = std::isfinite(setting.budget_us);
    std::vector<TickRow> now =
        replay(with_setting(scene_, setting), whole ? track_ : first_,
               {.budget_units = {}, .repeat = runs_.repeat, .processor_time = runs_.processor_time},
               {})
            .ticks;
    bool same = true;
    if (known) {
      same = std::equal(now.begin(), now.end(), known->begin(), same_answer);
      now.insert(now.end(), known->begin() + std::ptrdiff_t(now.size()), known->end());
    }
    folder_.save(setting, now);
    return same;
  }

  const SweepFolder& folder_;
  const config::Scene& scene_;
  const PoseTrack& track_;
  PoseTrack first_;  // the ticks that are timed
  SweepRuns runs_;
  const bake::Progress& progress_;
};

}  // namespace

std::size_t run_settings(const SweepFolder& folder, const config::Scene& scene,
                         const PoseTrack& track, std::span<const SweepSetting> settings,
                         const SweepRuns& runs, const bake::Progress& progress) {
  const Runs all(folder, scene, track, runs, progress);
  if (!all.whole_track_is_timed()) all.answer(settings);
  return all.time(settings);
}

}  // namespace palpate::cli
