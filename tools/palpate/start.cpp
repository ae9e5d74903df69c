// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/start.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "tools/palpate/command.hpp"
#include "tools/palpate/poses.hpp"

namespace palpate::cli {
namespace {

constexpr double kOverlapOfDelta = 0.01;

/// How deep each pair is.
std::map<std::uint32_t, double> depths_m(std::span<const Contact> contacts) {
  std::map<std::uint32_t, double> deepest;
  for (const Contact& c : contacts) {
    double& depth_m = deepest[c.pair];
    depth_m = std::max(depth_m, -c.distance_m);
  }
  return deepest;
}

}  // namespace

std::vector<config::Waypoint> hand_path(const std::filesystem::path& poses,
                                        const config::Scene& scene) {
  const PoseTrack track = read_poses(poses, scene);
  std::vector<config::Waypoint> path;
  for (const PoseTick& tick : track.ticks) {
    for (std::size_t i = tick.first; i < tick.first + tick.changes; ++i) {
      const PoseChange& change = track.changes[i];
      if (change.body != scene.tool) {
        throw Failure(kRefused, "the poses move '" + scene.bodies[change.body].name + "'",
                      poses.string(), "in a run the hand moves the tool alone: leave it out");
      }
      path.push_back({tick.t_s - track.ticks.front().t_s, change.pose});
    }
  }
  return path;
}

std::string overlap_line(const config::Scene& scene, std::span<const Contact> contacts) {
  std::string line;
  for (const auto& [pair, depth_m] : depths_m(contacts)) {
    if (depth_m <= kOverlapOfDelta * scene.settings.delta_m) continue;
    const BodyPair& of = scene.pairs[pair];
    char depth[32];
    std::snprintf(depth, sizeof depth, "%.2g", depth_m);
    line += (line.empty() ? "'" : "; '") + scene.bodies[of.a].name + "' and '" +
            scene.bodies[of.b].name + "' overlap at the start, by " + depth + " m";
  }
  return line;
}

std::string overlap_line(const config::Scene& scene, SceneEngine& engine, bool hand_on_path) {
  std::vector<Pose> poses = engine.start_poses();
  if (hand_on_path && !scene.hand.path.empty()) poses[scene.tool] = scene.hand.path.front().pose;
  TickResult result;
  const Status status = tick(engine.engine(), poses, {}, result);
  std::string line = status == Status::ok ? overlap_line(scene, result.contacts) : "";
  engine.restart();
  return line;
}

}  // namespace palpate::cli
