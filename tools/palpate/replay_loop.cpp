// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include "hal/clock.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/replay_loop.hpp"
#include "tools/palpate/scene_engine.hpp"

namespace palpate::cli {
namespace {

constexpr std::size_t kShowEvery = 64;  // ticks

class Replay {
 public:
  Replay(const config::Scene& scene, const PoseTrack& track, const ReplayOptions& options)
      : scene_(scene), track_(track), keep_contacts_(options.keep_contacts), engine_(scene) {
    if (options.budget_units) budget_.units = *options.budget_units;
    if (scene.budget_us) {
      budget_ns_ = static_cast<std::uint64_t>(*scene.budget_us * 1e3);
      budget_.clock_ns = [](void* clock) { return static_cast<hal::Clock*>(clock)->now_ns(); };
      budget_.clock_context = static_cast<hal::Clock*>(&clock_);
    }
  }

  Recording run_once(const std::function<void(double)>& show) {
    Recording out;
    out.image_bytes = engine_.image_bytes();
    out.engine_bytes = engine_.engine_bytes();
    out.ticks.reserve(track_.ticks.size());
    if (keep_contacts_) out.contacts.reserve(scene_.limits.contacts);
    std::vector<Pose> poses = engine_.start_poses();
    engine_.restart();
    for (std::size_t i = 0; i < track_.ticks.size(); ++i) {
      track_.apply(i, poses);
      tick_once(i, poses, out);
      if (i % kShowEvery == 0) show(double(i) / double(track_.ticks.size()));
    }
    return out;
  }

 private:
  void tick_once(std::size_t i, std::span<const Pose> poses, Recording& out) {
    TickResult r;
    const std::uint64_t start_ns = clock_.now_ns();
    budget_.deadline_ns = start_ns + budget_ns_;
    const Status status = tick(engine_.engine(), poses, budget_, r);
    const std::uint64_t end_ns = clock_.now_ns();
    if (status != Status::ok) {
      throw Failure(kOther, std::string("the engine failed (") + describe(status) + ")",
                    scene_.file.string() + ", tick " + std::to_string(i),
                    "check the poses of this tick");
    }
    out.ticks.push_back({track_.ticks[i].t_s, r.wrench, r.contacts.size(), r.clusters,
                         r.min_distance_m, r.front_nodes, r.queries, end_ns - start_ns,
                         r.certificate});
    if (!keep_contacts_) return;
    for (const Contact& contact : r.contacts) out.contacts.push_back({i, contact});
  }

  const config::Scene& scene_;
  const PoseTrack& track_;
  bool keep_contacts_;
  SceneEngine engine_;
  hal::MonotonicClock clock_;
  Budget budget_;
  std::uint64_t budget_ns_ = 0;
};

}  // namespace

Recording replay(const config::Scene& scene, const PoseTrack& track, const ReplayOptions& options,
                 const std::function<void(double done)>& show) {
  Replay loop(scene, track, options);
  Recording last;
  std::vector<std::vector<std::uint64_t>> times_of(track.ticks.size());
  for (unsigned k = 0; k < options.repeat; ++k) {
    last = loop.run_once([&](double done) { show((k + done) / options.repeat); });
    for (std::size_t i = 0; i < last.ticks.size(); ++i)
      times_of[i].push_back(last.ticks[i].time_ns);
  }
  for (std::size_t i = 0; i < last.ticks.size(); ++i) {
    const auto middle = times_of[i].begin() + std::ptrdiff_t(times_of[i].size() / 2);
    std::nth_element(times_of[i].begin(), middle, times_of[i].end());
    last.ticks[i].time_ns = *middle;
  }
  return last;
}

}  // namespace palpate::cli
