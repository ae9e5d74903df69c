// SPDX-License-Identifier: GPL-3.0-or-later
// Brings a tool to its gap: the tool of a scene, moved along an approach until its least distance
// from the rest is what is wanted.
#pragma once

#include <memory>
#include <vector>

#include "config/scene.hpp"
#include "tools/palpate/motion_paths.hpp"
#include "tools/palpate/scene_engine.hpp"

namespace palpate::cli {

/// Places one tick after another. The least distance is that of the scene's images by the regions
/// engine, exact, which the images must serve.
class MotionPlacing {
 public:
  /// @param scene  must outlive this; two bodies. Throws Failure as SceneEngine does, kUsage where
  /// there are not two bodies.
  explicit MotionPlacing(const config::Scene& scene);

  /// The tool's pose in world coordinates. Works outward from the last tick's place, back to where
  /// the gap is too large and forward again, by the distance that is surely free, by the slope
  /// found so far, or by halving: some ten queries. Right to 1 % of delta; a gap below 0.02 delta
  /// is made from that one by moving on by what is missing, so that the true overlap is at most
  /// what is asked for.
  Pose place(const Waymark& at, Closing closing);

 private:
  [[nodiscard]] Pose moved(const Waymark& at, double along_m) const;
  double distance_m(const Waymark& at, double along_m);
  double clearance_m(const Waymark& at);
  double free_place(const Waymark& at, double gap_m);
  double close(const Waymark& at, double from_m, double gap_m);

  const config::Scene& scene_;
  config::Scene wide_;  // the same with a tolerance that sees as far as placing needs
  std::unique_ptr<SceneEngine> engine_;
  std::vector<Pose> poses_;
  std::size_t tool_, other_;
  double last_m_ = 0;  // along the approach
  bool narrowed_ = false;
};

}  // namespace palpate::cli
