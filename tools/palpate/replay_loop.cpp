// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/replay_loop.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "tools/palpate/clocks.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/scene_engine.hpp"
#include "tools/palpate/scene_forces.hpp"
#include "tools/palpate/start.hpp"
#include "tools/palpate/surface_points.hpp"

namespace palpate::cli {
namespace {

constexpr std::size_t kShowEvery = 64;  // ticks

class Replay {
 public:
  Replay(const config::Scene& scene, const PoseTrack& track, const ReplayOptions& options)
      : forces_(scene),
        scene_(forces_.for_engine()),
        track_(track),
        engine_(scene_),
        surface_points_(engine_.images(), scene_.pairs),
        unlimited_(!options.budget_units && !scene.budget_us),
        clock_ns_(options.processor_time ? ProcessorClock::read : wall_ns) {
    if (options.budget_units) budget_.units = *options.budget_units;
    budget_.reserve_units = options.reserve_units;
    if (scene.budget_us) budget_ns_ = static_cast<std::uint64_t>(*scene.budget_us * 1e3);
    budget_.reserve_ns = static_cast<std::uint64_t>(scene.reserve_us.value_or(0) * 1e3);
    if (budget_ns_ || options.profile) {
      budget_.clock_ns = clock_ns_;
      budget_.clock_context = &processor_clock_;
    }
  }

  std::vector<TickRow> run_once(const ReplayListeners& listeners) {
    std::vector<TickRow> rows;
    rows.reserve(track_.ticks.size());
    std::vector<Pose> poses = engine_.start_poses();
    engine_.restart();
    forces_.restart();
    for (std::size_t i = 0; i < track_.ticks.size(); ++i) {
      track_.apply(i, poses);
      TickRow& row = rows.emplace_back();
      row.t_s = track_.ticks[i].t_s;
      TickResult result = complete_tick(i, poses, row.time_ns);
      forces_.add(row.t_s, poses, result);
      note(result, row);
      if (i == 0) start_overlap_ = overlap_line(scene_, result.contacts);
      if (listeners.contacts) listeners.contacts(i, surface_points_.of(result.contacts, poses));
      if (listeners.progress && i % kShowEvery == 0) {
        listeners.progress(double(i) / double(track_.ticks.size()));
      }
    }
    return rows;
  }

  [[nodiscard]] SceneEngine& engine() { return engine_; }
  [[nodiscard]] const std::string& start_overlap() const { return start_overlap_; }

 private:
  TickResult complete_tick(std::size_t i, std::span<const Pose> poses, std::uint64_t& out_ns) {
    TickResult result = timed_tick(i, poses, out_ns);
    while (unlimited_ && result.certificate.truncated_by_memory && engine_.grow()) {
      result = timed_tick(i, poses, out_ns);
    }
    return result;
  }

  TickResult timed_tick(std::size_t i, std::span<const Pose> poses, std::uint64_t& out_ns) {
    TickResult result;
    const std::uint64_t start_ns = clock_ns_(&processor_clock_);
    budget_.deadline_ns =
        budget_ns_ ? start_ns + *budget_ns_ : std::numeric_limits<std::uint64_t>::max();
    const Status status = tick(engine_.engine(), poses, budget_, result);
    out_ns = clock_ns_(&processor_clock_) - start_ns;
    if (status != Status::ok) {
      throw Failure(kOther, std::string("the engine failed (") + describe(status) + ")",
                    scene_.file.string() + ", tick " + std::to_string(i),
                    "check the poses of this tick");
    }
    return result;
  }

  static void note(const TickResult& result, TickRow& out) {
    out.wrench = result.wrench;
    out.contacts = result.contacts.size();
    out.clusters = result.clusters;
    out.min_distance_m = result.min_distance_m;
    out.front_nodes = result.front_nodes;
    out.queries = result.queries;
    out.certificate = result.certificate;
  }

  SceneForces forces_;
  config::Scene scene_;
  const PoseTrack& track_;
  SceneEngine engine_;
  SurfacePoints surface_points_;
  std::string start_overlap_;
  bool unlimited_;
  ProcessorClock processor_clock_;
  std::uint64_t (*clock_ns_)(void*);
  Budget budget_;
  std::optional<std::uint64_t> budget_ns_;
};

}  // namespace

Recording replay(const config::Scene& scene, const PoseTrack& track, const ReplayOptions& options,
                 const ReplayListeners& listeners) {
  Replay loop(scene, track, options);
  Recording out;
  std::vector<std::vector<std::uint64_t>> times_of(track.ticks.size());
  for (unsigned k = 0; k < options.repeat; ++k) {
    ReplayListeners now;
    if (listeners.progress) {
      now.progress = [&](double done) { listeners.progress((k + done) / options.repeat); };
    }
    if (k + 1 == options.repeat) now.contacts = listeners.contacts;
    out.ticks = loop.run_once(now);
    for (std::size_t i = 0; i < out.ticks.size(); ++i) times_of[i].push_back(out.ticks[i].time_ns);
  }
  for (std::size_t i = 0; i < out.ticks.size(); ++i) {
    const auto middle = times_of[i].begin() + std::ptrdiff_t(times_of[i].size() / 2);
    std::nth_element(times_of[i].begin(), middle, times_of[i].end());
    out.ticks[i].time_ns = *middle;
  }
  out.start_overlap = loop.start_overlap();
  out.image_bytes = loop.engine().image_bytes();
  out.engine_bytes = loop.engine().engine_bytes();
  out.limits = loop.engine().limits();
  if (const Counters* counted = counters(loop.engine().engine())) out.counters = *counted;
  return out;
}

}  // namespace palpate::cli
